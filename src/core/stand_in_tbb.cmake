# sheaf_stand_in_tbb(FOLDER HEADER): the headers of oneTBB that the library includes, in FOLDER, as HEADER has them: a path
# within the source tree.
function(sheaf_stand_in_tbb folder stand_in)
  foreach(header blocked_range global_control info parallel_for parallel_reduce partitioner task_arena task_group)
    file(CONFIGURE OUTPUT ${folder}/oneapi/tbb/${header}.h CONTENT "#include \"${stand_in}\"\n")
  endforeach()
endfunction()
