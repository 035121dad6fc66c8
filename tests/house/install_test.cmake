# Installs into a fresh folder, builds the program of the README's "Linking the engine" against it, and
# runs both that and the installed tumble, whose scenes and shaders must be found there. Run by ctest:
#   cmake -DBUILD=... -DSOURCE=... -DWORK=... -DCXX=... -P install_test.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "exit ${code}: ${ARGN}\n${out}\n${err}")
  endif()
  set(out "${out}" PARENT_SCOPE)
endfunction()

# The only block of README.md in this language.
function(readme_block language result)
  file(READ ${SOURCE}/README.md text)
  set(fence "```")
  string(FIND "${text}" "${fence}${language}\n" first)
  string(FIND "${text}" "${fence}${language}\n" last REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL last)
    message(FATAL_ERROR "README.md has not one block in ${language}")
  endif()
  string(LENGTH "${fence}${language}\n" opening)
  math(EXPR first "${first} + ${opening}")
  string(SUBSTRING "${text}" ${first} -1 text)
  string(FIND "${text}" "${fence}" end)
  string(SUBSTRING "${text}" 0 ${end} text)
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
readme_block(cmake lists)
readme_block(cpp program)
# As it stands, with the simulation alone, on a machine that lacks what only files need; and with
# everything.
foreach(component world engine)
  set(lacking)
  if(component STREQUAL "world")
    set(lacking -DCMAKE_DISABLE_FIND_PACKAGE_assimp=ON -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON)
  else()
    string(REPLACE " COMPONENTS world" "" lists "${lists}")
    string(REPLACE "tumble::world)" "tumble::engine)" lists "${lists}")
  endif()
  set(folder ${WORK}/mine_${component})
  file(WRITE ${folder}/CMakeLists.txt "${lists}")
  file(WRITE ${folder}/main.cpp "${program}")
  run(${CMAKE_COMMAND} -S ${folder} -B ${folder}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix
      -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=${FLAGS} ${lacking})
  run(${CMAKE_COMMAND} --build ${folder}/build)
  run(${folder}/build/mine)
  # From 10 m, by g t^2 / 2, to the order of the integrator.
  if(NOT out MATCHES "^5\\.[01]")
    message(FATAL_ERROR "the ball of the README's program is at y = ${out}")
  endif()
endforeach()

# Away from its source tree only the installed files can serve: an unknown root must not.
run(${WORK}/prefix/bin/tumble scenes --json)
if(NOT out MATCHES "${WORK}/prefix/share/tumble/scenes/")
  message(FATAL_ERROR "the installed program does not use its own scenes:\n${out}")
endif()
file(REMOVE_RECURSE ${WORK})
