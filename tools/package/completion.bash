# bash completion: commands and options as listed by tetwright itself, and files.
_tetwright() {
  local cur=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]}
  COMPREPLY=()
  local IFS=$'\n'  # file names may contain blanks
  if [ "$COMP_CWORD" = 1 ]; then
    local commands
    commands=$(tetwright --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z]*\) .*/\1/p')
    COMPREPLY=($(compgen -W "$commands"$'\n--help\n--version' -- "$cur"))
  elif [[ $cur == -* ]]; then
    local options
    options=$(tetwright "$command" --help 2>/dev/null | sed -n 's/^  \(-[a-z],\)\{0,1\}\(--[a-z-]*\).*/\2/p')
    COMPREPLY=($(compgen -W "$options" -- "$cur"))
  else
    COMPREPLY=($(compgen -f -- "$cur"))
  fi
}
complete -o filenames -F _tetwright tetwright
