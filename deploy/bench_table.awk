# For deploy/bench.sh: results as "program TAB benchmark TAB field TAB value" to a table of medians and ratios.
# Open3D's lines are "open3d TAB stage TAB our ms TAB its ms". Variable `simd`: the best instruction set measured.
BEGIN { FS = "\t" }

function number(x) { return sprintf(x < 10 ? "%.2f" : "%.1f", x) }
function title(text) {
  printf "\n%-40s %9s %-9s %-16s %9s %7s\n", text, "median", "unit", "against", "median", "ratio"
}
function row(what, ours, unit, against, theirs) {
  printf "%-40s %9s %-9s %-16s %9s %7s\n", what, number(ours), unit, against, number(theirs), \
    (ours > 0 ? sprintf("%.2f", theirs / ours) : "-")
}

function codecs(    i, name, other, what) {
  title("codecs")
  for (i = 1; i <= count["codec_benchmark"]; ++i) {
    name = names["codec_benchmark", i]
    other = name
    if (!sub(/isotherm$/, "png_1", other)) continue
    what = substr(name, 4)
    sub(/\/isotherm$/, "", what)
    row(what, value["codec_benchmark", name, "real_time"], "ms", "PNG, level 1", \
        value["codec_benchmark", other, "real_time"])
  }
}

# Nanoseconds per pixel, voxel or ray.
function per(name, unit) { return 1e9 * value["kernel_benchmark", name, "per_" unit] }

function kernels(    i, j, name, other, what, unit, units, common, ordered, last) {
  title("kernels, 2 threads, " simd)
  split("pixel voxel ray", units, " ")
  split("AVX2 NEON", common, " ")
  # They ran in random order.
  for (i = 1; i <= count["kernel_benchmark"]; ++i) {
    name = names["kernel_benchmark", i]
    if (name !~ "/simd:" simd "/threads:2$") continue
    j = value["kernel_benchmark", name, "family_index"]
    ordered[j] = name
    if (j > last) last = j
  }
  for (i = 0; i <= last; ++i) {
    if (!(i in ordered)) continue
    name = ordered[i]
    for (j in units) if (("kernel_benchmark", name, "per_" units[j]) in value) unit = units[j]
    what = substr(name, 4)
    sub(/\/simd.*/, "", what)
    other = name
    sub(/threads:2/, "threads:1", other)
    row(what, per(name, unit), "ns/" unit, "1 thread", per(other, unit))
    for (j in common) {
      other = name
      sub("simd:" simd, "simd:" common[j], other)
      if (other != name && ("kernel_benchmark", other) in seen)
        row("", per(name, unit), "ns/" unit, common[j], per(other, unit))
    }
  }
}

function line(    i, n, stages, key, run) {
  title("the line, simulated frames, 2 threads")
  run = "BM_Pipeline/voxel_mm:2/threads:"
  n = split("preprocess track integrate raycast depth_frame thermal_frame", stages, " ")
  for (i = 1; i <= n; ++i) {
    key = stages[i] "_p50_ms"
    row(stages[i], value["pipeline_benchmark", run 2, key], "ms", "1 thread", \
        value["pipeline_benchmark", run 1, key])
  }
}

function growth(    key) {
  title("growth with the scan and the volume")
  key = "last_period_p50_ms"
  row("depth frame, 0.96 m", value["growth_benchmark", "BM_Growth/periods:1/length_cm:96", key], "ms", \
      "3.84 m, 10 x way", value["growth_benchmark", "BM_Growth/periods:10/length_cm:384", key])
}

function reconstruct(    i, name) {
  title("isotherm reconstruct")
  for (i = 1; i <= count["reconstruct"]; ++i) {
    name = names["reconstruct", i]
    row(name, value["reconstruct", name, "p50_ms"], "ms", "95th percentile", \
        value["reconstruct", name, "p95_ms"])
  }
}

$1 == "open3d" { stage[++open3d_rows] = $2; ours[open3d_rows] = $3; theirs[open3d_rows] = $4; next }
{
  value[$1, $2, $3] = $4
  if (!(($1, $2) in seen)) {
    seen[$1, $2] = 1
    names[$1, ++count[$1]] = $2
  }
}

END {
  codecs()
  kernels()
  line()
  growth()
  if (count["reconstruct"] > 0) reconstruct()
  if (open3d_rows > 0) title("beside Open3D, frame by frame")
  for (i = 1; i <= open3d_rows; ++i) row(stage[i], ours[i], "ms", "Open3D", theirs[i])
}
