# Turns the list of implementation folders into one static library each and a generated registry.

# Declares the implementation in the current folder. PRECOMPILED are the headers of its library that most of its
# files include. With BATCH, so many of its files go to the compiler as one (0: all), which takes down to a tenth of the
# time: for folders that are as fast so (study/against); where small functions are many, GCC then inlines less.
# Whoever changes a file waits for its batch: 20 s at most on two cores.
function(mbs_implementation)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "BATCH" "SOURCES;LIBRARIES;INCLUDE_DIRECTORIES;PRECOMPILED")
  get_filename_component(name ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  add_library(implementation_${name} STATIC ${arg_SOURCES})
  target_include_directories(implementation_${name} SYSTEM PRIVATE ${arg_INCLUDE_DIRECTORIES})
  target_link_libraries(implementation_${name} PUBLIC mbs_public PRIVATE ${arg_LIBRARIES})
  list(LENGTH arg_SOURCES sources)
  # The preset for sanitizers has batches of its own.
  if(DEFINED arg_BATCH AND NOT CMAKE_UNITY_BUILD)
    set_target_properties(implementation_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${arg_BATCH})
  elseif(NOT CMAKE_UNITY_BUILD AND sources GREATER 3)
    # Reading headers is half of the time to compile. This leaves the compiled code as it is.
    target_precompile_headers(implementation_${name} PRIVATE
      <algorithm> <array> <cmath> <memory> <span> <string> <utility> <vector> <mbs/implementation.hpp>
      ${arg_PRECOMPILED})
  endif()
  set_property(GLOBAL APPEND PROPERTY MBS_AVAILABLE ${name})
endfunction()

# Keeps the implementation in the current folder visible as unavailable, with the reason.
function(mbs_unavailable reason)
  get_filename_component(name ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  set_property(GLOBAL PROPERTY MBS_UNAVAILABLE_${name} "${reason}")
  message(WARNING "implementation ${name} is unavailable: ${reason}")
endfunction()

# Keeps a variant that this build lacks visible, with the reason; the folder itself is available.
function(mbs_lacking variant reason)
  get_filename_component(name ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  set_property(GLOBAL APPEND_STRING PROPERTY MBS_LACKING_${name}
    ", {\"${variant}\", R\"reason(${reason})reason\"}")
endfunction()

# Adds every folder of the list and generates registry.cpp for them.
function(mbs_registry)
  set(declarations "")
  set(entries "")
  set(libraries "")
  set(seen "")
  foreach(name IN LISTS ARGN)
    if(name IN_LIST seen)
      message(FATAL_ERROR "implementations/CMakeLists.txt lists ${name} twice")
    endif()
    if(NOT name MATCHES "^[a-z][a-z0-9_]*$")
      message(FATAL_ERROR "implementations/CMakeLists.txt: '${name}' is not a lower-case identifier")
    endif()
    list(APPEND seen ${name})
    add_subdirectory(${name})
    get_property(available GLOBAL PROPERTY MBS_AVAILABLE)
    get_property(reason GLOBAL PROPERTY MBS_UNAVAILABLE_${name})
    if(name IN_LIST available)
      string(APPEND declarations "namespace mbs::${name} { Implementation implementation(); }\n")
      get_property(lacking GLOBAL PROPERTY MBS_LACKING_${name})
      string(REGEX REPLACE "^, " "" lacking "${lacking}")
      string(APPEND entries
             "      available(\"${name}\", mbs::${name}::implementation(), {${lacking}}),\n")
      list(APPEND libraries implementation_${name})
    elseif(reason)
      string(APPEND entries "      unavailable(\"${name}\", R\"reason(${reason})reason\"),\n")
    else()
      message(FATAL_ERROR "implementations/${name}/CMakeLists.txt calls neither "
                          "mbs_implementation() nor mbs_unavailable()")
    endif()
  endforeach()
  set(MBS_REGISTRY_DECLARATIONS "${declarations}")
  set(MBS_REGISTRY_ENTRIES "${entries}")
  configure_file(registry.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/registry.cpp @ONLY)
  # An object library: the harness asks for registry(), so its definition must not depend on link order.
  add_library(mbs_registry OBJECT ${CMAKE_CURRENT_BINARY_DIR}/registry.cpp)
  # Before the harness, which is optimised less: of a template that both have, the linker keeps the first copy.
  target_link_libraries(mbs_registry PRIVATE ${libraries} PUBLIC mbs_harness)
endfunction()
