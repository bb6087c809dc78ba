# Run by `cmake -P`: makes a source file that holds the bytes of another. Set by the caller: INPUT, OUTPUT, NAME (of the
# function in namespace isotherm that returns them as a string).
file(READ ${INPUT} bytes HEX)
string(LENGTH "${bytes}" digits)
math(EXPR size "${digits} / 2")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include <string>\nnamespace isotherm {\nstd::string ${NAME}();\nstd::string ${NAME}() {\n"
  "  static constexpr char kBytes[${size}] = {\n${bytes}};\n  return {kBytes, ${size}};\n}\n}\n")
