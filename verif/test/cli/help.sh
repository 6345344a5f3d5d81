#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage help, kage list, the man page and the completions: made of the same definitions as the commands themselves.
. "$(dirname "$0")/common.bash"

expect 0 "$kage" --help
cp "$temp/stdout" whole
expect 0 "$kage" help
cmp -s "$temp/stdout" whole || fail "kage help is not kage --help"
expect 0 "$kage" --version
cp "$temp/stdout" version
expect 0 "$kage" -V
cmp -s "$temp/stdout" version || fail "kage -V is not kage --version"
commands=$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\+\) .*/\1/p' whole)
[ "$(wc -w <<<"$commands")" -ge 12 ] || fail "these are all commands: $commands"
for command in $commands; do
  expect 0 "$kage" "$command" --help
  cp "$temp/stdout" one
  expect 0 "$kage" help "$command"
  diff <(grep -v ^Usage: one) <(grep -v ^Usage: "$temp/stdout") >/dev/null || fail "kage help $command is not kage $command --help"
  grep -q "^Usage: kage $command " "$temp/stdout" || fail "kage help $command does not say how it is used"
  grep -q "^Examples:" "$temp/stdout" || fail "$command has no examples"
  # Options stand in groups; only --help is in none.
  groups=$(grep -oE "^(Input|Picture|Core|Limits|Comparison|Run|Output|Options):$" "$temp/stdout" | tr -d '\n')
  [[ Input:Picture:Core:Limits:Comparison:Run:Output:Options: =~ (^|:)${groups//:/:.*}$ && $groups == *:Options: ]] ||
    fail "$command has groups $groups"
  [ "$(sed -n '/^Options:/,/^$/p' "$temp/stdout" | grep -c '^  -')" = 1 ] || fail "$command has options without a group"
  [ "$command" = help ] || grep -q -- --json "$temp/stdout" || fail "$command has no --json"
done
trouble "kage: renderr: no such command (did you mean render?); see kage --help" "$kage" help renderr
trouble "kage: nosuch: no such command; see kage --help" "$kage" help nosuch
trouble "" "$kage" help --man --zsh

# The names are those that commands take.
expect 0 "$kage" list configs
diff "$temp/stdout" <(sed -n 's/^\([a-z0-9]*\):.*/\1/p' "$source/rtl/defs/configs.yaml") || fail "list configs is not rtl/defs/configs.yaml"
expect 0 "$kage" list faults
diff "$temp/stdout" <(/usr/bin/python3 -B "$source/verif/cosim/model/driver/defects.py" "$source/verif/cosim/model/faults.yaml" list | cut -f1) || fail "list faults is not verif/cosim/model/faults.yaml"
expect 0 "$kage" list scenes
diff <(sort "$temp/stdout") <(cd "$source/scenes" && printf '%s\n' *.gltf | sed 's/\.gltf$//' | sort) || fail "list scenes is not scenes/"
expect 0 "$kage" list --json l.json
json l.json "all(len(s['about']) > 40 and len(s['about']) < 90 for s in j['scenes']) and len({s['about'] for s in j['scenes']}) == len(j['scenes'])"
expect 0 "$kage" list
python3 - l.json stdout <<'PY' || fail "list does not say what its JSON says"
import json, sys
text = open(sys.argv[2]).read()
assert all("  %-22s %s\n" % (e["name"], e["about"]) in text for key, group in json.load(open(sys.argv[1])).items() if key != "schema" for e in group if e["about"])
PY
[ -f "$source/$(sed -n '1s/.*; \(.*\) says more of each$/\1/p' stdout)" ] || fail "list points to a page that is not there: $(head -1 stdout)"
json l.json "set(j) == {'schema', 'scenes', 'configs', 'faults'} and all(f['about'].endswith('.') or f['about'].endswith('<.') for f in j['faults'])"
trouble "" "$kage" list pictures

# The man page: no warning of mandoc, and every option of every command.
expect 0 "$kage" help --man
cp "$temp/stdout" kage.1
if command -v mandoc >/dev/null; then
  # It has no date, so that the same sources make the same page.
  warnings=$(mandoc -T lint -W warning kage.1 | grep -v "missing date")
  [ -z "$warnings" ] || fail "man page: $warnings"
fi
for option in --size --max-size --bash --backpressure; do
  grep -qF -- "$(sed 's/-/\\-/g' <<<"$option")" kage.1 || fail "the man page lacks $option"
done

# Every variable of kage's own that the sources ask for.
variables=$(grep -rhoE '(getenv|positive)\("KAGE_[A-Z_]+"' "$source"/{cli,ref,verif/cosim} | grep -oE 'KAGE_[A-Z_]+' | sort -u)
[ "$(wc -w <<<"$variables")" -ge 6 ] || fail "these are all variables: $variables"
for variable in $variables; do
  grep -q "^\.B .*$variable" kage.1 || fail "the man page lacks $variable"
done

# Completions, as bash calls them.
expect 0 "$kage" help --bash
cp "$temp/stdout" kage.bash
cat >complete.bash <<'BASH'
compopt() { :; }
. ./kage.bash
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_kage
printf '%s\n' "${COMPREPLY[@]}"
BASH
completes() { # WORDS... -- EXPECTED...: among what is offered
  local words=() offered word
  while [ "$1" != -- ]; do words+=("$1") && shift; done
  shift
  offered=$(bash complete.bash "${words[@]}")
  for word in "$@"; do grep -qxF -- "$word" <<<"$offered" || fail "completion of '${words[*]}' lacks '$word': $offered"; done
}
touch mine.glb
completes "$kage" co -- cosim
completes "$kage" "" -- cosim render list help
completes "$kage" cosim court -- courtyard
completes "$kage" render mi -- mine.glb
completes "$kage" cosim --conf -- --config
completes "$kage" cosim courtyard --config so -- soft
completes "$kage" cosim courtyard --fault lost_t -- lost_token
completes "$kage" render x --order "" -- exact centroid submission
completes "$kage" cache "" -- list verify prune
completes "$kage" help ren -- render
[ -z "$(bash complete.bash "$kage" cosim x --config zzz)" ] || fail "a configuration zzz is offered"
expect 0 "$kage" help --zsh
cp "$temp/stdout" _kage
if command -v zsh >/dev/null; then
  registered=$(ZDOTDIR=$temp zsh -f -c 'autoload -U compinit; compinit -D; source ./_kage; print $_comps[kage]' 2>&1)
  [ "$registered" = _kage ] || fail "zsh does not take its completions: $registered"
fi
done_testing
