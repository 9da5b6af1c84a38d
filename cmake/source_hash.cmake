# cmake -DOUTPUT=FILE.cpp "-DSOURCES=A;B;..." [-DROOT=FOLDER] -P source_hash.cmake: a hash of the names and the content of these
# files, behind `SourceHash` (version.h). Names are those below ROOT; of a file elsewhere only the last part counts.
set(lines "")
foreach(source IN LISTS SOURCES)
  set(name "${source}")
  cmake_path(IS_PREFIX ROOT "${source}" NORMALIZE isBelow)
  if(isBelow)
    cmake_path(RELATIVE_PATH name BASE_DIRECTORY "${ROOT}")
  else()
    cmake_path(GET source FILENAME name)
  endif()
  file(SHA256 "${source}" hash)
  list(APPEND lines "${name} ${hash}")
endforeach()
list(SORT lines)
string(SHA256 hash "${lines}")
string(SUBSTRING "${hash}" 0 32 hash)
file(WRITE "${OUTPUT}" "// Made by cmake/source_hash.cmake.
#include \"src/render/version.h\"

namespace dapple {
std::string SourceHash() { return \"${hash}\"; }
}  // namespace dapple
")
