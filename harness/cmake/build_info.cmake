# Records commit, dirty flag, compiler and flags in `target`, afresh at every build.
set(MBS_BUILD_INFO_SCRIPTS ${CMAKE_CURRENT_LIST_DIR})

# Adds a generated build_info.cpp (see src/environment/build_info.hpp) to `target`. The file changes,
# and is compiled again, only when its content does.
function(mbs_build_info target)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/build_info)
  set(output ${folder}/build_info.cpp)

  # What is known now goes into a template; the script fills in the state of the repository.
  string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
  get_directory_property(options COMPILE_OPTIONS)
  string(JOIN " " flags ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}} ${options}
         -std=c++${CMAKE_CXX_STANDARD})
  string(REPLACE "${PROJECT_SOURCE_DIR}" "." MBS_FLAGS "${flags}")
  set(MBS_COMMIT "@MBS_COMMIT@")
  set(MBS_DIRTY "@MBS_DIRTY@")
  configure_file(${MBS_BUILD_INFO_SCRIPTS}/build_info.cpp.in ${folder}/build_info.cpp.in @ONLY)

  find_package(Git QUIET)
  add_custom_target(mbs_build_info
    COMMAND ${CMAKE_COMMAND} -DGIT=${GIT_EXECUTABLE} -DSOURCE=${PROJECT_SOURCE_DIR}
            -DTEMPLATE=${folder}/build_info.cpp.in -DOUTPUT=${output}
            -P ${MBS_BUILD_INFO_SCRIPTS}/write_build_info.cmake
    BYPRODUCTS ${output}
    COMMENT "Recording the commit"
    VERBATIM)
  add_dependencies(${target} mbs_build_info)
  target_sources(${target} PRIVATE ${output})
  set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # it changes with each commit
endfunction()
