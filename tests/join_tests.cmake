# Writes OUTPUT, one source that contains the test files FILES, so that what they all read is read once:
#   cmake -DOUTPUT=... "-DFILES=a_test.cpp;b_test.cpp" -P join_tests.cmake
# All their #include lines come first. Then each file follows in a namespace of its own, since helpers of
# different files may share names; the headers that it names have been read and add nothing to it.
set(includes "")
set(bodies "")
foreach(file IN LISTS FILES)
  file(STRINGS "${file}" lines REGEX "^#include ")
  list(APPEND includes ${lines})
  get_filename_component(name "${file}" NAME_WE)
  string(APPEND bodies "namespace joined_${name} {\n#include \"${file}\"\n}\n")
endforeach()
list(REMOVE_DUPLICATES includes)
list(JOIN includes "\n" includes)
file(WRITE "${OUTPUT}" "// Written by tests/join_tests.cmake.\n${includes}\n\n${bodies}")
