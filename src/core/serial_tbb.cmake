# sheaf_serial_tbb(FOLDER): the headers of oneTBB that the library includes, in FOLDER, as src/core/serial_tbb.h has them.
function(sheaf_serial_tbb folder)
  foreach(header blocked_range global_control info parallel_for parallel_reduce partitioner task_arena task_group)
    file(CONFIGURE OUTPUT ${folder}/oneapi/tbb/${header}.h CONTENT "#include \"src/core/serial_tbb.h\"\n")
  endforeach()
endfunction()
