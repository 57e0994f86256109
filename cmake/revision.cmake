# Run by `cmake -P` at every build: writes OUTPUT, the source with the git revision of SOURCE, if the revision has
# changed.
#
# The revision is the commit, with a checksum of later changes to the files that programs are built from:
# "5eed…+0123abcd". It is empty without git, and in a folder that is not a checkout of its own, such as one from a
# tarball.
set(parts CMakeLists.txt apps cmake include lab scenarios src viewer)
set(REVISION "")
find_package(Git QUIET)
if(GIT_FOUND AND EXISTS ${SOURCE}/.git)
  set(git ${CMAKE_COMMAND} -E env GIT_OPTIONAL_LOCKS=0 ${GIT_EXECUTABLE} -C ${SOURCE})
  execute_process(
    COMMAND ${git} rev-parse --verify HEAD
    RESULT_VARIABLE failed
    OUTPUT_VARIABLE commit
    ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  execute_process(
    COMMAND ${git} diff --no-ext-diff --no-color --binary HEAD -- ${parts}
    RESULT_VARIABLE diff_failed
    OUTPUT_VARIABLE changes
    ERROR_QUIET)
  if(NOT failed AND NOT diff_failed)
    set(REVISION ${commit})
    if(NOT changes STREQUAL "")
      string(SHA256 checksum "${changes}")
      string(SUBSTRING ${checksum} 0 8 checksum)
      string(APPEND REVISION +${checksum})
    endif()
  endif()
endif()
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)
