"""What the check of a wheel's machine code finds, in libraries compiled for each test."""

import subprocess
import zipfile

import pytest

import symbol_versions

ENTRY = "void* PyInit__core(void) { return 0; }\n"
FROM_SYSTEM = frozenset({"libc.so.6", "libm.so.6"})


@pytest.fixture
def wheel(tmp_path):
    def made(**sources):
        """A wheel with a library for each C source; flags for the linker follow a bar."""
        path = tmp_path / "riffler-0.1.0-cp311-cp311-linux_x86_64.whl"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("riffler/__init__.py", "")
            for name, source in sources.items():
                text, _, flags = source.partition("|")
                (tmp_path / "one.c").write_text(text)
                out = tmp_path / f"{name}.so"
                command = [
                    "cc",
                    "-shared",
                    "-fPIC",
                    "-fvisibility=hidden",
                    f"-L{tmp_path}",
                    tmp_path / "one.c",
                    "-o",
                    out,
                ]
                subprocess.run([*command, *flags.split()], check=True)
                archive.write(out, f"riffler/{name}.so")
        return path

    return made


SHOWN = '__attribute__((visibility("default"))) '


def test_a_library_that_needs_little_has_no_fault(wheel):
    assert symbol_versions.faults(wheel(_core=SHOWN + ENTRY), (2, 28), FROM_SYSTEM) == []


def test_a_symbol_of_a_newer_glibc_is_named_with_its_version(wheel):
    # pow has a version of 2.29 on x86-64 and ARM alike.
    made = wheel(_core=SHOWN + ENTRY + "double pow(double, double); double volatile x; "
                 "__attribute__((used)) static double f(void) { return pow(x, x); }|-lm")  # fmt: skip
    (needs,) = symbol_versions.needs_of_wheel(made)
    assert needs.glibc == (2, 29) and "libm.so.6" in needs.libraries
    assert symbol_versions.faults(made, (2, 28), FROM_SYSTEM) == ["riffler/_core.so needs glibc 2.29, newer than 2.28"]
    assert symbol_versions.faults(made, (2, 29), FROM_SYSTEM) == []


def test_versions_are_compared_as_numbers_and_private_ones_are_newest():
    def of(*versions):
        return symbol_versions.Needs("_core.so", frozenset(), frozenset(versions), frozenset()).glibc

    assert of("GLIBC_2.9", "GLIBC_2.28", "GLIBC_2.3.4", "GLIBCXX_3.4.30") == (2, 28)
    assert of("GLIBC_2.28.1") > (2, 28) and of("GLIBC_2.2.5", "GLIBC_PRIVATE") > (2, 99) and of() == ()


def test_a_library_that_is_not_inside_is_named(wheel, tmp_path):
    made = wheel(libother=SHOWN + ENTRY)
    made = wheel(_core=SHOWN + ENTRY + "|-Wl,--no-as-needed -lother")
    (needs,) = symbol_versions.needs_of_wheel(made)
    assert "libother.so" in needs.libraries
    assert symbol_versions.faults(made, (2, 99), FROM_SYSTEM) == [
        "riffler/_core.so needs libother.so, which is not inside"
    ]


def test_a_symbol_that_others_could_take_is_named(wheel):
    made = wheel(_core=SHOWN + ENTRY + SHOWN + "void __cxa_throw(void) {}")
    assert symbol_versions.faults(made, (2, 28), FROM_SYSTEM) == ["riffler/_core.so exports __cxa_throw"]


def test_a_wheel_without_machine_code_is_a_fault(wheel):
    assert symbol_versions.faults(wheel(), (2, 28), FROM_SYSTEM) == ["there is no machine code inside"]
