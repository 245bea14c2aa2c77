"""The completion scripts of bash, zsh and fish, from the list of verbs."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .completion import Entry, Option, Value

BASH = """\
# bash completion of riffler, printed by: riffler completion bash

_riffler_words() {  # offers the words that may stand here; no space follows one that ends with ":"
    COMPREPLY=($(compgen -W "$1" -- "$current"))
    [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *: ]] && compopt -o nospace 2>/dev/null
}

_riffler_files() {  # folders, and files whose suffix has one of these patterns
    local IFS=$'\\n' suffix
    compopt -o filenames 2>/dev/null
    COMPREPLY+=($(compgen -d -- "$current"))
    for suffix in "$@"; do
        COMPREPLY+=($(compgen -f -X "!*.$suffix" -- "$current"))
    done
}

_riffler() {
    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb=${COMP_WORDS[1]}
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
        _riffler_words "@first@"
        return
    fi
    case $verb in
@groups@
    esac
    case "$verb $before" in
@values@
    esac
    if [[ $current == -* ]]; then
        case $verb in
@options@
        esac
        return
    fi
    case $verb in
@inputs@
    esac
}

complete -F _riffler riffler
"""

ZSH = """\
#compdef riffler
# zsh completion of riffler, printed by: riffler completion zsh

_riffler() {
    local context state line verb=$words[2]
    local -a choices
    if (( CURRENT == 2 )); then
        choices=(
@first@
        )
        _describe 'command' choices
        return
    fi
    case $verb in
@groups@
    esac
    shift words
    (( CURRENT -= 1 ))
    case $verb in
@arguments@
    esac
}

if [[ $funcstack[1] == _riffler ]]; then
    _riffler "$@"
else
    compdef _riffler riffler
fi
"""

FISH = """\
# fish completion of riffler, printed by: riffler completion fish

function __riffler_at  # whether the command line begins with these words, its options aside
    set -l words (commandline -opc)[2..-1]
    test (count $words) -ge (count $argv); and test "$words[1..$(count $argv)]" = "$argv"
end

function __riffler_is  # whether the command line consists of exactly these words
    set -l words (commandline -opc)[2..-1]
    test "$words" = "$argv"
end

function __riffler_files  # files with these suffixes, and folders
    set -l suffixes (string join '|' $argv)
    __fish_complete_path (commandline -ct) | string match -rei -- "(?:/|\\.(?:$suffixes))(?:\t|\\$)"
end

complete -c riffler -f
@lines@
"""


def _filled(template: str, **parts: Sequence[str] | str) -> str:
    for name, lines in parts.items():
        template = template.replace(f"@{name}@", lines if isinstance(lines, str) else "\n".join(lines))
    return template


def _verbs(entries: Sequence[Entry], group: str) -> dict[str, str]:
    """What each verb of a group does, by name."""
    return {e.path.partition(" ")[2]: e.about for e in entries if e.path.startswith(f"{group} ")}


def _first(entries: Sequence[Entry], groups: Mapping[str, str]) -> dict[str, str]:
    return dict(groups) | {e.path: e.about for e in entries if " " not in e.path}


# ---- bash


def bash(entries: Sequence[Entry], groups: Mapping[str, str]) -> str:
    within = []
    for group in groups:
        names = " ".join(_verbs(entries, group))
        within.append(
            f"        {group})\n            if ((COMP_CWORD == 2)); then _riffler_words '{names}'; return; fi\n"
            f'            verb+=" ${{COMP_WORDS[2]}}" ;;'
        )
    values, options, inputs = [], [], []
    for e in entries:
        for option in e.options:
            if option.value is not None:
                names = " | ".join(f"'{e.path} {flag}'" for flag in option.flags)
                values.append(f"        {names}) {_bash_offer(option.value)}return ;;")
        flags = " ".join(flag for option in e.options for flag in option.flags)
        options.append(f"            '{e.path}') _riffler_words '{flags}' ;;")
        if e.values:
            inputs.append(f"        '{e.path}') {_bash_offer(e.values[0])};;")
    return _filled(
        BASH, first=" ".join(_first(entries, groups)), groups=within, values=values, options=options, inputs=inputs
    )


def _bash_offer(value: Value) -> str:
    words = f"_riffler_words '{' '.join(value.offer.words)}'; " if value.offer.words else ""
    # [sS][tT][lL]: bash 3.2, the version of macOS, cannot ignore case otherwise
    patterns = ["".join(f"[{c}{c.upper()}]" if c.isalpha() else c for c in s[1:]) for s in value.offer.suffixes]
    files = " ".join(f"'{pattern}'" for pattern in patterns)
    if value.name == "DIR":
        return words + "_riffler_files; "
    return words + (f"_riffler_files {files}; " if files else "")


# ---- zsh


def zsh(entries: Sequence[Entry], groups: Mapping[str, str]) -> str:
    within = []
    for group in groups:
        described = _zsh_described(_verbs(entries, group), 20)
        within.append(
            f"        {group})\n            if (( CURRENT == 3 )); then\n                choices=(\n{described}\n"
            "                )\n                _describe 'verb' choices\n                return\n            fi\n"
            '            verb="$verb $words[3]"\n            shift words\n            (( CURRENT -= 1 )) ;;'
        )
    arguments = []
    for e in entries:
        specs = [spec for option in e.options for spec in _zsh_option(option)]
        specs += [f"'{'*' if value.name == 'JOB' else '1'}:{value.name}:{_zsh_offer(value)}'" for value in e.values]
        arguments.append(f"        '{e.path}')\n            _arguments \\\n                "
                         + " \\\n                ".join(specs) + " ;;")  # fmt: skip
    return _filled(ZSH, first=_zsh_described(_first(entries, groups), 12), groups=within, arguments=arguments)


def _zsh_described(choices: Mapping[str, str], indent: int) -> str:
    return "\n".join(f"{' ' * indent}'{name}:{_zsh_text(about)}'" for name, about in choices.items())


def _zsh_text(text: str) -> str:
    """The text without characters that quote, group or separate in zsh's specifications."""
    return re.sub(r"[\[\]:'\\]", " ", text)


def _zsh_option(option: Option) -> list[str]:
    more = "*" if option.repeats else ""
    value = "" if option.value is None else f":{option.value.name}:{_zsh_offer(option.value)}"
    return [f"'{more}{flag}[{_zsh_text(option.about)}]{value}'" for flag in option.flags]


def _zsh_offer(value: Value) -> str:
    words = " ".join(word.replace(":", "\\:") for word in value.offer.words)
    if value.name == "DIR":
        return "_files -/"
    if value.offer.suffixes:
        pattern = "|".join(suffix.lstrip(".") for suffix in value.offer.suffixes)
        files = f'_files -g "*.(#i)({pattern})(-.)"'
        return f'_alternative "words\\:word\\:({words})" "files\\:file\\:{_zsh_nested(files)}"' if words else files
    return f"({words})" if words else " "


def _zsh_nested(files: str) -> str:
    return files.replace('"', '\\"')


# ---- fish


def fish(entries: Sequence[Entry], groups: Mapping[str, str]) -> str:
    lines = [f"complete -c riffler -n __riffler_is -a {name} -d {_fish_text(about)}"
             for name, about in _first(entries, groups).items()]  # fmt: skip
    for group in groups:
        lines += [
            f"complete -c riffler -n '__riffler_is {group}' -a {name} -d {_fish_text(about)}"
            for name, about in _verbs(entries, group).items()
        ]
    for e in entries:
        here = f"complete -c riffler -n '__riffler_at {e.path}'"
        lines += [f"{here} -a {_fish_offer(value)}" for value in e.values]
        for option in e.options:
            flags = " ".join(f"-l {flag[2:]}" for flag in option.flags)
            takes = "" if option.value is None else f" -x -a {_fish_offer(option.value)}"
            lines.append(f"{here} {flags}{takes} -d {_fish_text(option.about)}")
    return _filled(FISH, lines=lines)


def _fish_text(text: str) -> str:
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def _fish_offer(value: Value) -> str:
    parts = list(value.offer.words)
    if value.offer.suffixes:
        parts.append(f"(__riffler_files {' '.join(suffix[1:] for suffix in value.offer.suffixes)})")
    elif value.name == "DIR":
        parts.append("(__fish_complete_directories)")
    return f"'{' '.join(parts)}'"
