# The command hangpose, its completions for shells and its man pages. The target hangpose_command asks the command for
# them. It is not built with the library, which must build without the command.
set(dir ${CMAKE_CURRENT_BINARY_DIR}/command)
add_custom_command(
  OUTPUT ${dir}/hangpose
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${dir}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${dir}/man1
  COMMAND ${HANGPOSE_COMMAND} completions bash > ${dir}/hangpose.bash
  COMMAND ${HANGPOSE_COMMAND} completions zsh > ${dir}/_hangpose
  COMMAND ${HANGPOSE_COMMAND} completions fish > ${dir}/hangpose.fish
  COMMAND ${HANGPOSE_COMMAND} man ${dir}/man1
  COMMAND gzip --best --no-name --recursive ${dir}/man1
  COMMAND ${CMAKE_STRIP} --remove-section=.comment -o ${dir}/hangpose ${HANGPOSE_COMMAND}
  DEPENDS ${HANGPOSE_COMMAND}
  COMMENT "Writing completions and man pages"
  VERBATIM)
add_custom_target(hangpose_command DEPENDS ${dir}/hangpose)

# Packages of Debian have their own folder for zsh.
set(zsh_dir site-functions)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(zsh_dir vendor-completions)
endif()
install(PROGRAMS ${dir}/hangpose DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
install(FILES ${dir}/hangpose.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME hangpose
  COMPONENT command)
install(FILES ${dir}/_hangpose DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${zsh_dir} COMPONENT command)
install(FILES ${dir}/hangpose.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT command)
install(DIRECTORY ${dir}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT command)
