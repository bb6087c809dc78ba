# For deploy/bench.sh and deploy/bench_live.sh: processor time for each second of data, by stage and by thread. Reads one file
# for each run, a stats.json after flatten_json.awk; with lines "edge.processor X" and "edge.by_thread.NAME X", in cores, the
# edge too, and the sum of both. Variable `columns`: the runs' names, "alone|beside load".
# "ended" are threads that had ended when it was measured, "others" those below 0.005 in every run.
FNR == 1 { ++runs }
{ value[runs, $1] = $2 }
$1 ~ /^processor\.by_thread_s\./ { note_thread("ground", substr($1, 23)) }
$1 ~ /^edge\.by_thread\./ { note_thread("edge", substr($1, 16)) }

function note_thread(program, thread) {
  if ((program, thread) in seen) return
  seen[program, thread] = 1
  names[program, ++threads[program]] = thread
}
# Core-seconds in a second of data; "" if the run does not have it.
function per_second(run, key,    total_s) {
  if (!((run, key) in value)) return ""
  total_s = value[run, "processor.total_s"]
  return value[run, key] * value[run, "processor.per_second_of_data_s"] / total_s
}
function of_thread(program, thread, run) {
  if (program == "ground") return per_second(run, "processor.by_thread_s." thread)
  return value[run, "edge.by_thread." thread]
}
function of_stage(stage, run) { return per_second(run, "stages." stage ".processor_s") }

# Prints what `cell` has for each run, unless it rounds to nothing in all of them.
function row(what,    run, line, any) {
  for (run = 1; run <= runs; ++run) {
    any = any || cell[run] >= 0.005
    line = line sprintf(" %12s", cell[run] == "" ? "-" : sprintf("%.2f", cell[run]))
  }
  if (any) printf "%-52s%s\n", what, line
}
function stage_row(what, stage,    run) {
  for (run = 1; run <= runs; ++run) cell[run] = of_stage(stage, run)
  row(what)
}

function stages(    run, i, n, parts, measured) {
  n = split("preprocess track relocalise submaps raycast integrate", parts, " ")
  print (has_edge ? "ground, by stage" : "by stage")
  stage_row("  depth frame", "depth_frame")
  for (i = 1; i <= n; ++i) stage_row("    " parts[i], parts[i])
  for (run = 1; run <= runs; ++run) {
    cell[run] = of_stage("depth_frame", run)
    for (i = 1; i <= n && cell[run] != ""; ++i) cell[run] -= of_stage(parts[i], run)
  }
  row("    in between")
  stage_row("  thermal frame", "thermal_frame")
  stage_row("  merge of sub-maps", "merge")
  for (run = 1; run <= runs; ++run) {
    measured = of_stage("depth_frame", run) + of_stage("thermal_frame", run) + of_stage("merge", run)
    cell[run] = per_second(run, "processor.total_s")
    if (cell[run] != "") cell[run] -= measured
  }
  row(has_edge ? "  receiving, recording, feedback, console, end" : "  reading, decoding, passes at the end")
}

# Orders a program's threads by what they took in all runs together.
function sort_threads(program,    i, j, run, name) {
  for (i = 1; i <= threads[program]; ++i) {
    name = names[program, i]
    for (run = 1; run <= runs; ++run) sum[name] += of_thread(program, name, run)
    for (j = i; j > 1 && sum[names[program, j - 1]] < sum[name]; --j) names[program, j] = names[program, j - 1]
    names[program, j] = name
  }
  split("", sum)
}

function by_thread(program, total_key,    i, run, name, largest, others) {
  sort_threads(program)
  print (has_edge ? program ", by thread" : "by thread")
  for (run = 1; run <= runs; ++run) others[run] = total(program, run)
  for (i = 1; i <= threads[program]; ++i) {
    name = names[program, i]
    largest = 0
    for (run = 1; run <= runs; ++run) {
      cell[run] = of_thread(program, name, run)
      if (cell[run] > largest) largest = cell[run]
    }
    if (largest < 0.005 || name == "others") continue
    for (run = 1; run <= runs; ++run) if (others[run] != "") others[run] -= cell[run]
    row("  " name)
  }
  # What is left of rounded figures may be less than nothing.
  for (run = 1; run <= runs; ++run) cell[run] = others[run] == "" || others[run] > 0 ? others[run] : 0
  row("  others")
  for (run = 1; run <= runs; ++run) cell[run] = total(program, run)
  row(has_edge ? program ", all threads" : "all")
}
function total(program, run) {
  return program == "ground" ? per_second(run, "processor.total_s") : value[run, "edge.processor"]
}

END {
  has_edge = (1, "edge.processor") in value
  n = split(columns, column, "|")
  for (run = 1; run <= n; ++run) header = header sprintf(" %12s", column[run])
  printf "\n%-52s%s\n", "processor time for each second of data, core-seconds", header
  stages()
  by_thread("ground")
  if (!has_edge) exit
  by_thread("edge")
  for (run = 1; run <= runs; ++run) cell[run] = total("ground", run) + total("edge", run)
  row("both programs")
}
