# SPDX-License-Identifier: MIT
# Configures, builds and runs the consumers beside this file, HOW = installed | subdirectory.
file(REMOVE_RECURSE ${WORK})
set(consumers consumer consumer_of_lattice)

if(HOW STREQUAL "installed")
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${DELF_BUILD} --config ${BUILD_TYPE} --prefix ${WORK}/prefix
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  set(find -D CMAKE_PREFIX_PATH=${WORK}/prefix)
else()
  # One room is compiled again: what is tested is how delf is found and linked.
  set(consumers consumer_of_lattice)
  set(BUILD_TYPE Debug)
  set(find -D DELF_SOURCE=${DELF_SOURCE} -D CMAKE_CXX_FLAGS_DEBUG=-O0)
endif()

execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -G ${GENERATOR}
  -D CMAKE_BUILD_TYPE=${BUILD_TYPE} -D CMAKE_CXX_COMPILER=${COMPILER} ${find} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/build --config ${BUILD_TYPE} --target ${consumers}
  COMMAND_ERROR_IS_FATAL ANY)

foreach(consumer IN LISTS consumers)
  find_program(${consumer}_program ${consumer} PATHS ${WORK}/build PATH_SUFFIXES ${BUILD_TYPE}
    NO_DEFAULT_PATH REQUIRED)
  execute_process(COMMAND ${${consumer}_program} OUTPUT_VARIABLE space_step COMMAND_ERROR_IS_FATAL ANY)
  if(NOT space_step MATCHES "^0\\.1568627450980392")  # 40/255
    message(FATAL_ERROR "${consumer} printed ${space_step}")
  endif()
endforeach()
