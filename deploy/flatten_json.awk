# A file of JsonText, two spaces a level and one value a line, as lines "path.to.key value". Elements of arrays that are
# objects are counted from 1: "link.load_shedding.changes.1.level".
{
  level = int(match($0, /[^ ]/) / 2)
  if ($0 ~ /^ +[{]$/) {
    key[level] = ++count[level]
    next
  }
  if (!match($0, /"[^"]*": /)) next
  key[level] = substr($0, RSTART + 1, RLENGTH - 4)
  value = substr($0, RSTART + RLENGTH)
  sub(/,$/, "", value)
  if (value == "[") count[level + 1] = 0
  if (value == "{" || value == "[") next
  path = key[1]
  for (i = 2; i <= level; ++i) path = path "." key[i]
  print path, value
}
