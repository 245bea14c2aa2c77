"""``riffler completion``: the scripts, as bash, zsh and fish run them. A shell that is not installed is skipped; bash
is everywhere."""

import json
import os
import pty
import select
import shutil
import subprocess
import time

import pytest
from commands import riffle
from riffler import cli
from riffler.command import completion, verbs

FILES = ("box.stl", "BOX.STL", "part.obj", "slot.ngc", "left.rvol", "plan.json", "notes.txt", "two words.stl")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Files to choose from, and the scripts."""
    found = tmp_path_factory.mktemp("completion")
    for name in FILES:
        (found / name).touch()
    (found / "parts").mkdir()
    for shell in completion.SHELLS:
        done = riffle("completion", shell, cwd=found)
        assert done.returncode == 0 and done.stderr == ""
        (found / f".{shell}").write_text(done.stdout)
    return found


def need(shell):
    if not shutil.which(shell):
        pytest.skip(f"{shell} is not installed: apt-get install {shell}")


def bash(folder, line):
    """What bash offers at the end of the line."""
    words = line.split(" ")
    quoted = " ".join(f"'{word}'" for word in words)
    code = f"source ./.bash; COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; _riffler; "
    code += 'printf "%s\\n" "${COMPREPLY[@]}"'
    done = subprocess.run(["bash", "--norc", "-c", code], cwd=folder, capture_output=True, text=True, check=True,
                          timeout=30)  # fmt: skip
    # compopt works only while a completion runs
    assert done.stderr == "" or "compopt" in done.stderr, done.stderr
    return {word for word in done.stdout.splitlines() if word}


def fish(folder, line):
    need("fish")
    code = f"source ./.fish; complete -C '{line}'"
    env = os.environ | {"HOME": str(folder), "XDG_CONFIG_HOME": str(folder / ".config")}
    done = subprocess.run(["fish", "--no-config", "-c", code], cwd=folder, env=env, capture_output=True, text=True,
                          check=True, timeout=30)  # fmt: skip
    assert done.stderr == ""
    return {word.split("\t")[0].rstrip("/") for word in done.stdout.splitlines()}


MESHES = {"box.stl", "BOX.STL", "part.obj", "two words.stl", "parts"}
CASES = {
    "groups": ("riffler ", {*verbs.GROUPS, *verbs.ALONE}),
    "beginning of a group": ("riffler vol", {"volume"}),
    "verbs": ("riffler volume ", set(verbs.of("volume"))),
    "beginning of a verb": ("riffler mesh de", {"decimate"}),
    "no verb like it": ("riffler mesh x", set()),
    "options": ("riffler mesh decimate --t", {"--tolerance", "--triangles"}),
    "option's words": ("riffler volume from-mesh --directions ", {"z", "xyz"}),
    "detail": ("riffler volume carve --detail ", {"all"}),
    "machines": ("riffler nc post --post linuxcnc-xyza", {"linuxcnc-xyzac"}),
    "meshes": ("riffler mesh audit ", MESHES),
    "a mesh by its beginning": ("riffler mesh audit bo", {"box.stl"}),
    "files of an option": ("riffler volume carve --out ", MESHES | {"left.rvol"}),
    "program by its name": ("riffler nc verify --program sl", {"slot.ngc"}),
    "programs": ("riffler nc verify s", {"slot.ngc"}),
    "plans": ("riffler plan swarf --plan pl", {"plan.json"}),
    "devices": ("riffler pen monitor simu", {"simulated"}),
    "after a number": ("riffler volume from-mesh --pitch ", set()),
    "shells": ("riffler completion ", {"bash", "fish", "zsh"}),
    "jobs": ("riffler bench b2", {"b200"}),
}


@pytest.mark.parametrize("case", CASES)
def test_bash_offers_the_right_words_and_files(folder, case):
    line, expected = CASES[case]
    assert bash(folder, line) == expected


@pytest.mark.parametrize("case", CASES)
def test_fish_offers_the_right_words_and_files(folder, case):
    line, expected = CASES[case]
    offered = fish(folder, line)
    assert offered - {"parts"} == expected - {"parts"}


# In place of riffler: its arguments, so that they are seen however the line was drawn.
SHOW = "riffler() { printf '<%s>' \"$@\"; }\n"
SHOWN = "<volume><from-mesh><box.stl><--pitch><0.5><--directions><xyz>"


def typed(command, folder, lines):
    """What an interactive shell shows after lines of keys. Each is typed when the one before has been executed: a word
    has appeared that the terminal's echo of its command does not contain."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(folder)
        os.execvpe(command[0], command, os.environ | {"TERM": "dumb", "HOME": str(folder)})
    seen = b""
    try:
        for k, line in enumerate(["", *lines]):
            os.write(terminal, f"{line}echo do''ne{k}\n".encode())
            end = time.monotonic() + 60
            while f"done{k}".encode() not in seen:
                assert time.monotonic() < end, f"{command[0]} did not execute {line!r}: {seen!r}"
                if select.select([terminal], [], [], 0.1)[0]:
                    seen += os.read(terminal, 65536)
    finally:
        os.kill(pid, 9)
        os.waitpid(pid, 0)
        os.close(terminal)
    return seen.decode(errors="replace")


def test_bash_completes_as_one_types(folder):
    keys = ["source ./.bash; " + SHOW, "riffler vol\tfr\tbo\t--pi\t0.5 --dir\txy\t\n"]
    keys += ["riffler mesh audit two\t--js\t\n"]
    shown = typed(["bash", "--norc", "--noprofile", "-i"], folder, keys)
    assert SHOWN in shown and "<mesh><audit><two words.stl><--json>" in shown


def test_zsh_completes_as_one_types(folder):
    need("zsh")
    keys = ["autoload -Uz compinit; compinit -u -D; source ./.zsh; " + SHOW]
    keys += ["riffler vol\tfr\tbox\t--pi\t0.5 --dir\txy\t\n"]
    keys += ["riffler mesh audit two\t--js\t\n"]
    shown = typed(["zsh", "-f", "-i"], folder, keys)
    assert SHOWN in shown and "<mesh><audit><two words.stl><--json>" in shown


def test_the_scripts_have_every_verb_and_option():
    for shell, script in completion.SHELLS.items():
        text = script(completion.entries(), verbs.GROUPS)
        for entry in completion.entries():
            assert entry.path in text, (shell, entry.path)
            for option in entry.options:
                for flag in option.flags:
                    assert (f"-l {flag[2:]} " if shell == "fish" else flag) in text, (shell, entry.path, flag)


def test_json_has_the_script(capsys):
    assert cli.main(["completion", "bash"]) == 0
    script = capsys.readouterr().out
    assert cli.main(["completion", "bash", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"shell": "bash", "script": script}
