#compdef tetwright
# zsh completion: commands and options as listed by tetwright itself, and files.
local -a commands options
if (( CURRENT == 2 )); then
  commands=(${(f)"$(tetwright --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z]*\)  *\(.*\)/\1:\2/p')"})
  _describe -t commands command commands
elif [[ $PREFIX == -* ]]; then
  options=(${(f)"$(tetwright $words[2] --help 2>/dev/null | sed -n 's/^  \(-[a-z],\)\{0,1\}\(--[a-z-]*\).*/\2/p')"})
  compadd -a options
else
  _files
fi
