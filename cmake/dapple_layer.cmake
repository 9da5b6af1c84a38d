# Compiler options that every target of the project shares.
add_library(dapple_options INTERFACE)
target_include_directories(dapple_options INTERFACE ${PROJECT_SOURCE_DIR})
# GCC 12 takes the inside of an empty std::optional for uninitialised values: -Wno-maybe-uninitialized.
# Clang builds for the fuzzer alone; the warnings are GCC's.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(dapple_options INTERFACE -Wall -Wextra -Wconversion -Wno-sign-conversion -Wshadow
                                                  -Wno-maybe-uninitialized -Werror)
endif()
target_compile_options(dapple_options INTERFACE -fno-math-errno -fno-trapping-math $<$<CONFIG:Release>:-O3>)
if(DAPPLE_INSTRUCTION_SET STREQUAL "native")
  target_compile_options(dapple_options INTERFACE -march=native)
elseif(DAPPLE_INSTRUCTION_SET STREQUAL "portable")
  target_compile_options(dapple_options INTERFACE -march=x86-64-v3 -ffp-contract=off)
  target_compile_definitions(dapple_options INTERFACE DAPPLE_PORTABLE)
else()
  message(FATAL_ERROR "DAPPLE_INSTRUCTION_SET is '${DAPPLE_INSTRUCTION_SET}': expected native or portable")
endif()
if(DAPPLE_SANITIZE)
  # Without "no-recover" a report of undefined behaviour would be a line on the error stream, and the test would pass.
  target_compile_options(dapple_options INTERFACE -fsanitize=${DAPPLE_SANITIZE} -fno-sanitize-recover=all
                                                  -fno-omit-frame-pointer)
  target_link_options(dapple_options INTERFACE -fsanitize=${DAPPLE_SANITIZE})
endif()

# dapple_layer(NAME FOLDER DEPENDENCY...): the static library dapple_NAME of all sources in FOLDER.
function(dapple_layer name folder)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp ${folder}/*.h)
  add_library(dapple_${name} STATIC ${sources})
  target_link_libraries(dapple_${name} PUBLIC ${ARGN} PRIVATE dapple_options)
  target_include_directories(dapple_${name} PUBLIC ${PROJECT_SOURCE_DIR})
endfunction()
