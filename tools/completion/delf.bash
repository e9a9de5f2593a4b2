# SPDX-License-Identifier: MIT
# Completion of delf for bash: commands, scenes and keys, as the program itself lists them.
_delf() {
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]-}
  local program=${COMP_WORDS[0]}
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "$("$program" help 2>/dev/null | sed -n 's/^  delf \([a-z]*\) .*/\1/p' | sort -u)" -- "$word")
    return
  fi
  case $command in
    help) mapfile -t COMPREPLY < <(compgen -W "$("$program" help 2>/dev/null | sed -n 's/^  delf \([a-z]*\) .*/\1/p') lagrangians measures" -- "$word") ;;
    list) mapfile -t COMPREPLY < <(compgen -W "theories stencils schemes states scenes" -- "$word") ;;
    resume)
      if [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "--run.until= --run.steps= --run.threads= --output.checkpoint=" -- "$word")
      else
        mapfile -t COMPREPLY < <(compgen -d -- "$word")
      fi
      ;;
    *)
      if [[ $word == -* ]]; then
        # of the command and of every run
        mapfile -t COMPREPLY < <(compgen -W "--out $({ "$program" help run; "$program" help "$command"; } 2>/dev/null |
          sed -n 's/^  \([a-z]*\.[a-z_]*\) .*/--\1=/p')" -- "$word")
      else
        mapfile -t COMPREPLY < <(compgen -W "$("$program" list scenes 2>/dev/null | sed -n 's/^  \([a-z0-9-]*\) .*/\1/p')" -- "$word"
          compgen -f -- "$word")
      fi
      ;;
  esac
  [[ ${COMPREPLY[0]-} == *= ]] && compopt -o nospace
}
# A key and its value are one word.
COMP_WORDBREAKS=${COMP_WORDBREAKS//=/}
complete -o filenames -F _delf delf
