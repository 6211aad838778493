# The hot loops of packing, of runs and of mesh walls, compiled once more for each newer instruction set; which runs is
# chosen at start.
set(kernels_of_demshape lib/clump/pack_kernels.c)
set(kernels_of_dem lib/sim/kernels.c lib/sim/mesh_spots.c)
if(DEM_X86)
  foreach(level v3 v4)
    foreach(library dem demshape)
      set(kernels ${library}_kernels_${level})
      add_library(${kernels} OBJECT ${kernels_of_${library}})
      target_include_directories(${kernels} PRIVATE lib lib/include)
      target_compile_definitions(${kernels} PRIVATE DEM_KERNELS=${level})
      target_compile_options(${kernels} PRIVATE -march=x86-64-${level})
      if(level STREQUAL v4)
        # whole registers: by default gcc keeps to half of them
        target_compile_options(${kernels} PRIVATE -mprefer-vector-width=512)
      endif()
      if(DEM_SANITIZE)
        # instrumented, the loops take minutes to compile in full
        target_compile_options(${kernels} PRIVATE -O1)
      endif()
      target_link_libraries(${kernels} PRIVATE dem_flags OpenMP::OpenMP_C)
      # under sanitizers clang cannot make vector code of all loops it is asked to, and would stop at that
      target_compile_options(${kernels} PRIVATE $<$<C_COMPILER_ID:Clang>:-Wno-pass-failed>)
      target_sources(${library} PRIVATE $<TARGET_OBJECTS:${kernels}>)
    endforeach()
  endforeach()
  target_compile_definitions(demshape PRIVATE DEM_X86=1)
  target_compile_definitions(dem PRIVATE DEM_X86=1)
endif()
