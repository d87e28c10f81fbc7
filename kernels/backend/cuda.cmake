# kernels/backend/direct.cu as target sherd_cuda, where nvcc is found and understands C++20 (12.0 on). One object file by
# a plain command: CMake's CUDA language would hand the host compiler's warning flags to nvcc and slow every configuration.
# Compiling needs no device.
if(NOT SHERD_CUDA STREQUAL "AUTO" AND NOT SHERD_CUDA)
  return()
endif()

find_program(SHERD_NVCC nvcc HINTS ENV CUDA_PATH ENV CUDA_HOME PATHS /usr/local/cuda PATH_SUFFIXES bin)
set(nvcc_options -std=c++20 -O3 -I${CMAKE_SOURCE_DIR} -gencode=arch=compute_80,code=sm_80
  -gencode=arch=compute_90,code=[sm_90,compute_90])
if(SHERD_NVCC AND NOT DEFINED SHERD_NVCC_WORKS)
  file(WRITE ${CMAKE_BINARY_DIR}/cuda_probe.cu "#include <string>\\n__global__ void probe(float* p) { *p = 1; }\\n")
  execute_process(COMMAND ${SHERD_NVCC} ${nvcc_options} -c cuda_probe.cu -o cuda_probe.o
    WORKING_DIRECTORY ${CMAKE_BINARY_DIR} RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE nvcc_errors)
  if(failed)
    message(STATUS "${SHERD_NVCC} fails on a test program: ${nvcc_errors}")
    set(SHERD_NVCC_WORKS OFF CACHE INTERNAL "")
  else()
    set(SHERD_NVCC_WORKS ON CACHE INTERNAL "")
  endif()
endif()
if(NOT SHERD_NVCC OR NOT SHERD_NVCC_WORKS)
  if(NOT SHERD_CUDA STREQUAL "AUTO")
    message(FATAL_ERROR "SHERD_CUDA=${SHERD_CUDA}, but no nvcc that works was found; set SHERD_NVCC or SHERD_CUDA=OFF")
  endif()
  message(STATUS "No nvcc that works: the sums over pairs are not compiled for CUDA")
  return()
endif()

set(cuda_object ${CMAKE_BINARY_DIR}/direct_cuda.o)
add_custom_command(OUTPUT ${cuda_object}
  COMMAND ${SHERD_NVCC} ${nvcc_options} -MD -MT ${cuda_object} -MF ${cuda_object}.d
    -c ${CMAKE_SOURCE_DIR}/kernels/backend/direct.cu -o ${cuda_object}
  DEPENDS ${CMAKE_SOURCE_DIR}/kernels/backend/direct.cu
  DEPFILE ${cuda_object}.d
  COMMENT "Building CUDA object direct_cuda.o" VERBATIM)
add_custom_target(sherd_cuda_object ALL DEPENDS ${cuda_object})

get_filename_component(cuda_home ${SHERD_NVCC} REALPATH)
get_filename_component(cuda_home ${cuda_home} DIRECTORY)
find_library(SHERD_CUDART cudart_static HINTS ${cuda_home}/.. ENV CUDA_PATH PATHS /usr/local/cuda
  PATH_SUFFIXES lib64 lib targets/x86_64-linux/lib)
if(SHERD_CUDART)
  find_package(Threads REQUIRED)
  add_library(sherd_cuda STATIC ${cuda_object})
  set_target_properties(sherd_cuda PROPERTIES LINKER_LANGUAGE CXX)
  add_dependencies(sherd_cuda sherd_cuda_object)
  target_link_libraries(sherd_cuda PUBLIC sherd_fundamental ${SHERD_CUDART} Threads::Threads ${CMAKE_DL_LIBS} rt)
else()
  message(STATUS "No cudart_static beside ${SHERD_NVCC}: CUDA code is compiled but not linked")
endif()
