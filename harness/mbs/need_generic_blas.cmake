# Fails, and removes the PROGRAM, if it needs a BLAS or LAPACK by its maker's name. READELF lists what it needs.
execute_process(COMMAND ${READELF} -d ${PROGRAM} OUTPUT_VARIABLE needed RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${READELF} cannot read ${PROGRAM}")
endif()
string(REGEX MATCHALL "lib[a-z_]*(openblas|goto|atlas|blis|flame|mkl|armpl)[^]]*" foreign "${needed}")
if(foreign)
  file(REMOVE ${PROGRAM})
  message(FATAL_ERROR "the program needs ${foreign}: every pair of --blas would be that one. In the CMakeLists.txt of the "
                      "implementation that links it, set(BLA_VENDOR Generic) before find_package(BLAS) or (LAPACK)")
endif()
