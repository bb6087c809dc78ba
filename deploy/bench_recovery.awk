# For deploy/bench_live.sh: how long after a load the ground was back at full rate. Reads a stats.json after flatten_json.awk;
# variables `load_begin` and `load_end`: when the load ran, seconds since the Unix epoch.
# "As before" is a half second at a level that is not above the median of those before the load. Times are to half a second.
# Levels of load shedding are counted from 0, nothing left out, in the order of ground/pipeline/load_shedding.h.
BEGIN {
  levels = split("none half_thermal sparse_thermal every_second every_fourth", names, " ")
  for (i = 1; i <= levels; ++i) rank[names[i]] = i - 1
}
$1 == "link.load_shedding.begun_unix_s" { begun = $2 }
$1 == "link.load_shedding.until_s" { until = $2 }
$1 ~ /^link\.load_shedding\.changes\.[0-9]+\.since_s$/ { since[++changes] = $2 }
$1 ~ /^link\.load_shedding\.changes\.[0-9]+\.level$/ { gsub(/"/, "", $2); level[changes] = rank[$2] }

function line(what, text) { printf "%-52s %s\n", what, text }
function seconds(s) { return sprintf("%.1f s", s > 0 ? s : 0) }
function level_at(time,    i) {
  for (i = changes; i > 1 && since[i] > time; --i) {}
  return level[i]
}
# The level that half of the time from `from` to `to` is not above; `highest` is set too.
function median_level(from, to,    time, n, count, i, sum) {
  highest = 0
  for (time = from; time < to; time += period) {
    ++n
    ++count[level_at(time)]
    if (level_at(time) > highest) highest = level_at(time)
  }
  for (i = 0; i < levels; ++i) {
    sum += count[i]
    if (2 * sum >= n) return i
  }
}
# How long after `end` the level was first not above `limit`.
function until_first(limit, end,    i) {
  if (level_at(end) <= limit) return seconds(0)
  for (i = 1; i <= changes; ++i) if (since[i] >= end && level[i] <= limit) return seconds(since[i] - end)
  return "not within the " seconds(until - end) " to the scan's end"
}
# How long after `end` the level was last above `limit`.
function until_last(limit, end) {
  if (level[changes] > limit) return "still so at the scan's end, " seconds(until - end) " later"
  for (i = changes - 1; i >= 1 && level[i] <= limit; --i) {}
  return i < 1 ? seconds(0) : seconds(since[i + 1] - end)
}

END {
  begin = load_begin - begun
  end = load_end - begun
  if (changes == 0 || since[1] > begin) {
    print "bench_recovery: stats.json does not tell how load shedding was before the load" >"/dev/stderr"
    exit 70
  }
  period = 0.5  # As in ground/pipeline/load_shedding_history.h.
  # A scan begins with frames that waited for it.
  before = median_level(begin > 4 ? 2 : 0, begin)
  printf "\nrecovery: a load from %s to %s of a scan of %s\n", seconds(begin), seconds(end), seconds(until)
  line("load shedding before the load, median / highest", names[before + 1] " / " names[highest + 1])
  beside = median_level(begin, end)
  line("load shedding beside the load, median / highest", names[beside + 1] " / " names[highest + 1])
  line("load's end to the first half second as before", until_first(before, end))
  line("load's end to the first with nothing left out", until_first(0, end))
  line("load's end to the end of the last one above before", until_last(before, end))
  line("load's end to the end of the last that left work out", until_last(0, end))
}
