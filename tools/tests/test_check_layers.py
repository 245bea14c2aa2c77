"""What tools/check_layers.py refuses, each in a small tree of its own."""

import pytest

import check_layers
import cpp_types
from shell import ROOT


@pytest.fixture
def tree(tmp_path):
    """write(path, text) puts a file under native/ of a tree with the topics base and nc."""
    (tmp_path / "CMakeLists.txt").write_text("set(RIFFLER_TOPICS base nc)\n")

    def write(path: str, text: str) -> None:
        file = tmp_path / "native" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    write.root = tmp_path
    return write


def test_a_topic_below_is_refused(tree):
    tree("base/io.hpp", '#include "nc/program.hpp"\n')
    tree("nc/program.hpp", '#include "base/io.hpp"\n')
    assert check_layers.core_problems(tree.root) == [
        "native/base/io.hpp:1: base includes nc/program.hpp, which is not above it"
    ]


def test_a_function_whose_bits_differ_between_systems_is_refused_in_the_core(tree):
    tree("base/a.cpp", "const double d = std::hypot(x, y);\n")
    tree("nc/b.cpp", "const double d = geom::hypot(x, y) + base::sin(x) + std::sqrt(y);\n")
    tree("nc/c.cpp", "const double d = std::atan2(x, y);\n")
    tree("tests/nc/b_test.cpp", "const double d = std::hypot(x, y);\n")
    assert check_layers.bit_problems(tree.root) == [
        "native/base/a.cpp:1: std::hypot differs between systems: use geom::hypot",
        "native/nc/c.cpp:1: std::atan2 differs between systems: use base::atan2",
    ]


def test_headers_of_one_system_are_for_its_folders(tree):
    text = "#include <unistd.h>\n#include <sys/stat.h>\n#include <csignal>\n#include <zlib.h>\n"
    for path in ("base/posix/a.cpp", "pen/hid/posix/b.cpp", "tests/nc/c_test.cpp"):
        tree(path, text)
    tree("base/windows/a.cpp", "#include <windows.h>\n")
    assert check_layers.system_problems(tree.root) == []
    tree("nc/a.cpp", text)
    tree("base/a.cpp", text)
    tree("include/riffler/pen/b.hpp", text)
    assert check_layers.system_problems(tree.root) == [
        f"native/{path}:{line}: <{name}> is of one kind of system: call it in native/base/posix and /windows"
        for path in ("base/a.cpp", "include/riffler/pen/b.hpp", "nc/a.cpp")
        for line, name in ((1, "unistd.h"), (2, "sys/stat.h"))
    ]
    for path in ("nc/a.cpp", "base/a.cpp", "include/riffler/pen/b.hpp"):
        tree(path, "")
    tree("base/a.cpp", '#include "base/posix/b.hpp"\n')
    assert check_layers.system_problems(tree.root) == [
        "native/base/a.cpp:1: includes base/posix/b.hpp, which other systems do not have"
    ]


def test_reading_and_writing_meet_in_machine_only(tree):
    tree("nc/read/reader.cpp", '#include "nc/machine/machine.hpp"\n#include "nc/write/post.hpp"\n')
    tree("nc/program.hpp", '#include "nc/read/reader.hpp"\n')
    assert check_layers.folder_problems(tree.root) == [
        "native/nc/program.hpp:1: nc includes nc/read/reader.hpp; of its topic's other folders it may use none",
        "native/nc/read/reader.cpp:2: nc/read includes nc/write/post.hpp; of its topic's other folders it may use nc, "
        "nc/machine",
    ]


def test_circles_of_files_are_refused_through_sources_too(tree):
    tree("nc/a.hpp", '#include "nc/b.hpp"\n')
    tree("nc/b.hpp", "")
    tree("nc/b.cpp", '#include "nc/b.hpp"\n#include "nc/c.hpp"\n')
    tree("nc/c.hpp", '#include "base/io.hpp"\n')
    tree("base/io.hpp", "")
    assert check_layers.circle_problems(tree.root) == []
    tree("nc/c.hpp", '#include "nc/a.hpp"\n')
    assert check_layers.circle_problems(tree.root) == ["a circle of files: nc/a → nc/b → nc/c → nc/a"]


def test_a_source_in_a_folder_includes_its_own_header_first(tree):
    tree("nc/read/reader.hpp", "")
    tree("nc/read/reader.cpp", '#include <string>\n#include "nc/read/reader.hpp"\n')
    assert check_layers.header_problems(tree.root) == [
        "native/nc/read/reader.cpp: includes string before nc/read/reader.hpp"
    ]


def test_a_type_of_two_files_is_refused_and_hidden_ones_are_not(tree):
    hidden = "namespace riffler {\nnamespace {\nstruct Box { int a; };\n}\nclass Reader { struct Box {}; };\n}\n"
    tree("base/a.hpp", "namespace riffler {\nstruct Box { int a; };\nclass Later;\n}\n")
    tree("base/b.cpp", hidden)
    assert check_layers.type_problems(tree.root) == []
    tree("nc/c.hpp", "namespace riffler {\nenum class Box : unsigned char { Open };\n}\n")
    assert check_layers.type_problems(tree.root) == ["riffler::Box is defined twice: base/a.hpp, nc/c.hpp"]
    tree("nc/c.hpp", "namespace riffler::nc {\nenum class Box : unsigned char { Open };\n}\n")
    assert check_layers.type_problems(tree.root) == []


def test_a_topic_keeps_to_its_namespace_and_names_central_types_in_riffler(tree):
    own = "namespace riffler::base {\nnamespace {\nint hidden();\n}\nstruct Ring {};\n}  // namespace riffler::base\n"
    tree("base/ring.hpp", own + "\nnamespace riffler {\nusing base::Ring;\n}  // namespace riffler\n")
    tree("base/kernels.cpp", "HWY_BEFORE_NAMESPACE();\nnamespace riffler::base::HWY_NAMESPACE {\nint cut();\n}\n")
    tree("base/hash.hpp", "template <>\nstruct std::hash<riffler::base::Ring> {\n  int of;\n};\n")
    assert check_layers.namespace_problems(tree.root) == []
    tree("base/more.hpp", "namespace riffler {\nstruct Type {};\nint function();\nnamespace {\nint hidden();\n}\n}\n")
    tree("base/none.hpp", "int outside();\nnamespace {\nint unnamed();\n}\n")
    tree("nc/more.hpp", own)
    assert check_layers.namespace_problems(tree.root) == [
        "native/base/more.hpp: outside of namespace riffler::base: struct Type",
        "native/base/more.hpp: outside of namespace riffler::base: int function()",
        "native/base/more.hpp: outside of namespace riffler::base: int hidden()",
        "native/base/none.hpp: outside of namespace riffler::base: int outside()",
        "native/base/none.hpp: outside of namespace riffler::base: int unnamed()",
        "native/nc/more.hpp: outside of namespace riffler::nc: int hidden()",
        "native/nc/more.hpp: outside of namespace riffler::nc: struct Ring",
    ]


def test_types_are_found_behind_templates_literals_and_comments():
    text = """
    // struct Comment {};
    namespace riffler {
    const char* text = "struct Literal {";
    constexpr auto raw = R"({ struct Raw {)";
    constexpr char brace = '{';
    constexpr int digits = 1'000'000;
    template <class T, class U = std::vector<T>>
    class Ring final : public Base<T> { enum Inner { A }; };
    template <>
    struct Ring<int, int> {};
    template <class T>
    using Pair = std::pair<T, T>;
    struct Outer { struct Nested; };
    struct Outer::Nested { int a; };
    struct Made make(struct Argument* a) { struct Local {}; return {}; }
    }  // namespace riffler
    namespace riffler::nc { union Value { int a; float b; }; }
    """
    names = ["riffler::Ring", "riffler::Pair", "riffler::Outer", "riffler::nc::Value"]
    assert ["::".join(found) for found in cpp_types.defined(text)] == names


def test_the_core_has_types_and_each_once():
    found = cpp_types.definitions(ROOT / "native")
    assert len(found) > 500
    assert [path.removeprefix("include/riffler/") for path in found["riffler::nc::Program"]] == ["nc/program.hpp"]
    assert check_layers.type_problems(ROOT) == []
    assert check_layers.circle_problems(ROOT) == []
    assert check_layers.public_problems(ROOT) == []


def test_public_headers_stand_in_their_topic(tree):
    tree("include/riffler/base/io.hpp", '#include "riffler/nc/program.hpp"\n')
    tree("include/riffler/nc/program.hpp", "")
    assert check_layers.core_problems(tree.root) == [
        "native/include/riffler/base/io.hpp:1: base includes nc/program.hpp, which is not above it"
    ]
    tree("nc/program.cpp", '#include "riffler/base/io.hpp"\n#include "riffler/nc/program.hpp"\n')
    assert check_layers.header_problems(tree.root) == [
        "native/nc/program.cpp: includes riffler/base/io.hpp before riffler/nc/program.hpp"
    ]
    assert check_layers.circle_problems(tree.root) == ["a circle of files: base/io → nc/program → base/io"]


def test_a_public_header_needs_nothing_private(tree):
    tree("nc/rows.hpp", "")
    tree(
        "include/riffler/nc/program.hpp",
        '#include <glm/glm.hpp>\n#include <vector>\n\n#include "riffler/nc/rows.hpp"\n',
    )
    tree("include/riffler/nc/zip.hpp", '#include <zlib.h>\n#include <hidapi/hidapi.h>\n\n#include "nc/rows.hpp"\n')
    assert check_layers.public_problems(tree.root) == [
        "native/include/riffler/nc/program.hpp:4: a public header includes riffler/nc/rows.hpp, which is private",
        "native/include/riffler/nc/zip.hpp:1: a public header includes <zlib.h>, of another library than GLM",
        "native/include/riffler/nc/zip.hpp:2: a public header includes <hidapi/hidapi.h>, of another library than GLM",
        "native/include/riffler/nc/zip.hpp:4: a public header includes nc/rows.hpp, which is private",
    ]
    tree("include/riffler/nc/rows.hpp", "")
    assert check_layers.public_problems(tree.root)[0] == (
        "native/include/riffler/nc/rows.hpp: there is a private header of that name too"
    )
