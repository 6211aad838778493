# the packer's kernels and those of mesh walls, compiled once more for each newer instruction set; which one runs is
# chosen at start
if(DEM_X86)
  foreach(level v3 v4)
    add_library(dem_kernels_${level} OBJECT lib/clump/pack_kernels.c)
    add_library(dem_mesh_kernels_${level} OBJECT lib/sim/mesh_spots.c)
    foreach(kernels dem_kernels_${level} dem_mesh_kernels_${level})
      target_include_directories(${kernels} PRIVATE lib lib/include)
      target_compile_definitions(${kernels} PRIVATE DEM_KERNELS=${level})
      target_compile_options(${kernels} PRIVATE -march=x86-64-${level})
      target_link_libraries(${kernels} PRIVATE dem_flags OpenMP::OpenMP_C)
      # under sanitizers clang cannot make vector code of all loops it is asked to, and would stop at that
      target_compile_options(${kernels} PRIVATE $<$<C_COMPILER_ID:Clang>:-Wno-pass-failed>)
    endforeach()
    target_sources(demshape PRIVATE $<TARGET_OBJECTS:dem_kernels_${level}>)
    target_sources(dem PRIVATE $<TARGET_OBJECTS:dem_mesh_kernels_${level}>)
  endforeach()
  # whole registers: by default gcc keeps to half of them
  target_compile_options(dem_kernels_v4 PRIVATE -mprefer-vector-width=512)
  target_compile_options(dem_mesh_kernels_v4 PRIVATE -mprefer-vector-width=512)
  target_compile_definitions(demshape PRIVATE DEM_X86=1)
  target_compile_definitions(dem PRIVATE DEM_X86=1)
endif()
