# Writes the man pages and completions of the command SHEAF into the folder TO.
#
#   cmake -DSHEAF=build/release/sheaf -DTO=build/release/manual [-DCOMPRESS=ON] -P src/app/write_manual.cmake
#
# Beside the pages lie compressed ones, as Debian wants them, where COMPRESS is on.
file(MAKE_DIRECTORY ${TO})
function(write name)
  execute_process(COMMAND ${SHEAF} ${ARGN} OUTPUT_FILE ${TO}/${name} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
write(sheaf.1 man)
write(sheaf.bash completion bash)
write(_sheaf completion zsh)
# The page of all names each command.
file(STRINGS ${TO}/sheaf.1 names REGEX "^\\.BR sheaf.-[a-z]+ \\(1\\)$")
list(TRANSFORM names REPLACE "^\\.BR sheaf.-([a-z]+) .*" "\\1")
list(REMOVE_DUPLICATES names)
foreach(name IN LISTS names)
  write(sheaf-${name}.1 man ${name})
endforeach()
if(COMPRESS)
  file(GLOB pages ${TO}/*.1)
  execute_process(COMMAND gzip -9nkf ${pages} COMMAND_ERROR_IS_FATAL ANY)
endif()
