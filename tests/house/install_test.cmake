# Installs into a fresh folder, builds a stranger's program against it, and runs both that and the
# installed tumble, whose scenes and shaders must be found there. Run by ctest:
#   cmake -DBUILD=... -DSOURCE=... -DWORK=... -DCXX=... -P install_test.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "exit ${code}: ${ARGN}\n${out}\n${err}")
  endif()
  set(out "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
# Once with everything, once with the simulation alone, on a machine that lacks what only files need.
foreach(component "" world)
  set(lacking)
  if(component)
    set(lacking -DCMAKE_DISABLE_FIND_PACKAGE_assimp=ON -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON)
  endif()
  set(build ${WORK}/consumer_${component})
  run(${CMAKE_COMMAND} -S ${SOURCE}/tests/house/consumer -B ${build} -G Ninja
      -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release
      -DCMAKE_CXX_FLAGS=${FLAGS} -DCOMPONENT=${component} ${lacking})
  run(${CMAKE_COMMAND} --build ${build})
  run(${build}/consumer)
endforeach()

# Away from its source tree only the installed files can serve: an unknown root must not.
run(${WORK}/prefix/bin/tumble scenes --json)
if(NOT out MATCHES "${WORK}/prefix/share/tumble/scenes/")
  message(FATAL_ERROR "the installed program does not use its own scenes:\n${out}")
endif()
file(REMOVE_RECURSE ${WORK})
