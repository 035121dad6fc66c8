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
run(${CMAKE_COMMAND} -S ${SOURCE}/tests/house/consumer -B ${WORK}/consumer -G Ninja
    -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${WORK}/consumer)
run(${WORK}/consumer/consumer)

# Away from its source tree only the installed files can serve: an unknown root must not.
run(${WORK}/prefix/bin/tumble scenes --json)
if(NOT out MATCHES "${WORK}/prefix/share/tumble/scenes/")
  message(FATAL_ERROR "the installed program does not use its own scenes:\n${out}")
endif()
file(REMOVE_RECURSE ${WORK})
