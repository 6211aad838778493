# the packer's kernels, compiled once more for each newer instruction set; which one runs is chosen at start
if(DEM_X86)
  foreach(level v3 v4)
    add_library(dem_kernels_${level} OBJECT lib/clump/pack_kernels.c)
    target_include_directories(dem_kernels_${level} PRIVATE lib lib/include)
    target_compile_definitions(dem_kernels_${level} PRIVATE DEM_KERNELS=${level})
    target_compile_options(dem_kernels_${level} PRIVATE -march=x86-64-${level})
    target_link_libraries(dem_kernels_${level} PRIVATE dem_flags)
    target_sources(demshape PRIVATE $<TARGET_OBJECTS:dem_kernels_${level}>)
  endforeach()
  # whole registers: by default gcc keeps to half of them
  target_compile_options(dem_kernels_v4 PRIVATE -mprefer-vector-width=512)
  target_compile_definitions(demshape PRIVATE DEM_X86=1)
endif()
