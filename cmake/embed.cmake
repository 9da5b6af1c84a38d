# cmake -DOUTPUT=FILE.cpp -DINPUTS=A;B;... -P embed.cmake: the files as arrays of bytes, behind `ReportFile` (report_page.h).
set(arrays "")
set(choices "")
foreach(input IN LISTS INPUTS)
  get_filename_component(name "${input}" NAME)
  string(MAKE_C_IDENTIFIER "${name}" identifier)
  file(READ "${input}" bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND arrays "constexpr char ${identifier}[] = {${bytes}};\n")
  string(APPEND choices "  if (name == \"${name}\") return {${identifier}, sizeof(${identifier})};\n")
endforeach()
file(WRITE "${OUTPUT}" "// Made by cmake/embed.cmake.
#include \"src/app/report_page.h\"

namespace dapple {
namespace {
${arrays}}  // namespace

std::string_view ReportFile(std::string_view name) {
${choices}  return {};
}
}  // namespace dapple
")
