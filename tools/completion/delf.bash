# SPDX-License-Identifier: MIT
# Completion of delf for bash: commands, scenes, keys and their values, as the program itself lists them.

# The word before the cursor, --KEY=VALUE as one, whether COMP_WORDBREAKS breaks it at = or not.
_delf_word() {
  local before=${COMP_LINE:0:COMP_POINT}
  printf '%s' "${before##*[[:space:]]}"
}

_delf() {
  local word previous=${COMP_WORDS[COMP_CWORD-1]-} command=${COMP_WORDS[1]-} program=${COMP_WORDS[0]}
  local begin rest
  word=$(_delf_word)
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "$("$program" help 2>/dev/null | sed -n 's/^  delf \([a-z]*\) .*/\1/p' | sort -u)" -- "$word")
    return
  fi
  if [[ $word == --*=* ]]; then  # a value; of several, the last
    compopt +o filenames 2>/dev/null
    rest=${word#*=}
    begin=
    [[ $rest == *,* ]] && begin=${rest%,*},
    rest=${rest##*,}
    [[ $COMP_WORDBREAKS == *=* ]] || begin=${word%%=*}=$begin
    case ${word%%=*} in
      --fields | --nearby | --initial.file | --lattice.mesh | --sweep.settings)
        mapfile -t COMPREPLY < <(compgen -f -P "$begin" -- "$rest") ;;
      --out) mapfile -t COMPREPLY < <(compgen -d -P "$begin" -- "$rest") ;;
      *)
        local key=${word%%=*}
        mapfile -t COMPREPLY < <(compgen -P "$begin" -W "$("$program" help "${key#--}" 2>/dev/null |
          sed -n 's/^  \([^ ]*\)$/\1/p')" -- "$rest") ;;
    esac
    return
  fi
  case $previous in
    --fields | --nearby) mapfile -t COMPREPLY < <(compgen -f -- "$word"); return ;;
    --out) mapfile -t COMPREPLY < <(compgen -d -- "$word"); return ;;
  esac
  case $command in
    help) mapfile -t COMPREPLY < <(compgen -W "$("$program" help 2>/dev/null | sed -n 's/^  delf \([a-z]*\) .*/\1/p') lagrangians measures" -- "$word") ;;
    list) mapfile -t COMPREPLY < <(compgen -W "theories stencils schemes states scenes results" -- "$word") ;;
    resume | film | report | xdmf)
      if [[ $word == -* ]]; then
        local options='--run.until= --run.steps= --run.threads= --output.checkpoint='
        [[ $command == film ]] && options=--film.seconds=
        [[ $command == report ]] && options=--out
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
      else
        mapfile -t COMPREPLY < <(compgen -d -- "$word")
      fi
      ;;
    *)
      if [[ $word == -* ]]; then
        # of the command and of every run
        local options=--out
        [[ $command == verify ]] && options+=' --fields --dataset --nearby'
        [[ $command == plan ]] && options='--latex --modified'
        [[ $command == run ]] && options+=' --overwrite'
        mapfile -t COMPREPLY < <(compgen -W "$options $({ "$program" help run; "$program" help "$command"; } 2>/dev/null |
          sed -n 's/^  \([a-z]*\.[a-z_]*\) .*/--\1=/p' | sort -u)" -- "$word")
      elif [[ $command == reproduce ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$("$program" list results 2>/dev/null | sed -n 's/^  \([^ ]*\) .*/\1/p')" -- "$word")
      else
        mapfile -t COMPREPLY < <(compgen -W "$("$program" list scenes 2>/dev/null | sed -n 's/^  \([a-z0-9-]*\) .*/\1/p')" -- "$word"
          compgen -f -- "$word")
      fi
      ;;
  esac
  [[ ${COMPREPLY[0]-} == *= ]] && compopt -o nospace
}
complete -o filenames -F _delf delf
