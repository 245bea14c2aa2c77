"""Random NC programs of which nearly all are sound: what they hold is drawn from a grammar, numbers from a grid."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

LETTERS = "XYZ"
CENTRES = "IJK"
PLANES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}
SYSTEMS = ["54", "55", "56", "59", "59.1", "59.3"]


class Grammar:
    def __init__(self, rng: random.Random):
        self.rng = rng
        self.plane, self.absolute, self.mode = 17, True, 94
        # What LinuxCNC 2.9 gets wrong is left out: G53, G28 and G30 of a turned system under G92 (its interpreter puts
        # the G92 offset outside the turn, its motion planner inside), and do loops after a break has been executed
        # (they end after their first turn).
        self.turned = self.shifted = self.broke = False
        self.label = 1000
        self.depth = 0

    # --- Values ---

    def number(self, low: float = -20, high: float = 20) -> float:
        return round(self.rng.uniform(low, high), self.rng.choice([0, 1, 3, 4]))

    def value(self, x: float) -> str:
        """The number as a program may write it."""
        kind = self.rng.randrange(12)
        if kind == 0:
            return f"[{x:.5f} + 1 - 1]"
        if kind == 1:
            return f"[{2 * x:.5f} / 2]"
        if kind == 2:
            return f"[[{x:.5f}] * COS[0] + 0 * [2 ** 3 MOD 5]]"
        if kind == 3:
            return f"-[{-x:.5f}]"
        if kind == 4:
            return f"[{x:.5f} * [1 LT 2] + [3 EQ 4]]"
        if kind == 5:
            return f"[{x:.5f} + SIN[30] - SQRT[0.25] + FIX[0.7] + ATAN[0]/[1]]"
        text = f"{x:.5f}"
        return self.rng.choice([text, text.rstrip("0") if "." in text else text, text.replace("0.", ".", 1)])

    def to(self, axis: int, by: float) -> str:
        """The word that moves an axis by so much, in either distance mode."""
        if self.absolute:
            return f"{LETTERS[axis]}[#{5420 + axis} + {by:.6f}]"
        return f"{LETTERS[axis]}{by:.6f}"

    # --- Blocks ---

    def line(self) -> str:
        axes = self.rng.sample(range(3), self.rng.randint(1, 3))
        code = self.rng.choice(["G0", "G1", "G1", "g01", "G00"])
        words = [LETTERS[k] + self.value(self.number()) for k in axes]
        if self.rng.random() < 0.15:
            words += [self.rng.choice("AC") + self.value(self.number(-90, 90))]
        self.rng.shuffle(words)
        if self.mode == 93 and code.lower() in ("g1", "g01"):
            words.append(f"F{self.rng.uniform(1, 9):.2f}")
        elif self.rng.random() < 0.2:
            words.append(self.feed())
        return code + self.rng.choice(["", " "]).join(["", *words])

    def feed(self) -> str:
        return f"F{self.rng.uniform(0.05, 0.5):.3f}" if self.mode == 95 else f"F{self.rng.uniform(10, 900):.1f}"

    def arc(self) -> str:
        u, v, w = PLANES[self.plane]
        radius, start = self.rng.uniform(0.5, 15), self.rng.uniform(0, 2 * math.pi)
        counter = self.rng.random() < 0.5
        sweep = self.rng.choice([0.3, 1.0, 2.0, math.pi, 4.0, 5.5]) * (1 if counter else -1)
        full = self.rng.random() < 0.15
        move = [
            radius * (math.cos(start + sweep) - math.cos(start)),
            radius * (math.sin(start + sweep) - math.sin(start)),
        ]
        words = [] if full else [self.to(u, move[0]), self.to(v, move[1])]
        if self.rng.random() < 0.3:
            words.append(self.to(w, self.rng.uniform(-3, 3)))
        by_radius = not full and abs(abs(sweep) - math.pi) > 0.1 and self.rng.random() < 0.4
        prefix = ""
        if by_radius:
            words.append(f"R{radius if abs(sweep) < math.pi else -radius:.6f}")
        else:
            centre = [-radius * math.cos(start), -radius * math.sin(start)]
            if self.rng.random() < 0.3:
                prefix = "G90.1 "
                words += [f"{CENTRES[k]}[#{5420 + k} + {c:.6f}]" for k, c in zip((u, v), centre, strict=True)]
            else:
                prefix = self.rng.choice(["G91.1 ", "g91.1"])
                words += [f"{CENTRES[k]}{c:.6f}" for k, c in zip((u, v), centre, strict=True)]
        if self.rng.random() < 0.2:
            words.append(f"P{self.rng.randint(1, 3)}")
        if self.rng.random() < 0.1:
            words.append(f"A{self.number(-30, 30)}")
        if self.mode == 93:
            words.append(f"F{self.rng.uniform(1, 9):.2f}")
        return f"{prefix}G{3 if counter else 2} " + " ".join(words)

    def cycle(self) -> list[str]:
        if self.mode == 93:
            return []
        u, v, w = PLANES[self.plane]
        code = self.rng.choice([73, 81, 82, 83, 85, 89])
        clear, depth = self.number(0, 9), self.number(-20, -1)
        if not self.absolute:
            clear, depth = -self.number(0, 5), -self.number(1, 9)
        words = [f"R{clear}", f"{LETTERS[w]}{depth}", f"{LETTERS[u]}{self.number()}"]
        if self.rng.random() < 0.6:
            words.append(f"{LETTERS[v]}{self.number()}")
        if code in (73, 83):
            words.append(f"Q{self.rng.uniform(1, 6):.2f}")
        if code in (82, 89):
            words.append("P.5")
        if self.rng.random() < 0.3:
            words.append(f"L{self.rng.randint(1, 3)}")
        out = [self.rng.choice(["G98 ", "G99 ", ""]) + f"G{code} " + " ".join(words)]
        for _ in range(self.rng.randint(0, 3)):
            again = self.rng.choice(["", "", "", "G98 ", "G99 "]) + f"{LETTERS[self.rng.choice([u, v])]}{self.number()}"
            if self.rng.random() < 0.2:
                again += f" R{clear + 1:.3f}"
            if self.rng.random() < 0.2:
                again += f" {LETTERS[w]}{depth - 1:.3f}"
            out.append(again)
        return [*out, "G80"] if self.rng.random() < 0.7 else out

    def modes(self) -> list[str]:
        kind = self.rng.randrange(7)
        if kind == 0:
            return [self.rng.choice(["G20", "G21"])]
        if kind == 1:
            self.absolute = self.rng.random() < 0.5
            return ["G90" if self.absolute else "G91"]
        if kind == 2 and not self.turned:
            self.plane = self.rng.choice([17, 18, 19])
            return [f"G{self.plane}"]
        if kind == 3:
            self.mode = self.rng.choice([93, 94, 95])
            return [f"G{self.mode} " + (self.feed() if self.mode != 93 else "")]
        if kind == 4:
            return [f"S{self.rng.randint(100, 9000)} {self.rng.choice(['M3', 'm4'])}"]
        if kind == 5:
            return [f"T{self.rng.randint(1, 3)} M6", "G43"]
        idle = ["G61", "G64 P0.1 Q.02", "G4 P.1", "G61.1", "M8", "M9", "M1", "M48", "(MSG, hello)", "G40 G49"]
        return [self.rng.choice(idle)]

    def words_of_axes(self, letters: str = "XYZ") -> str:
        chosen = self.rng.sample(letters, self.rng.randint(1, len(letters)))
        return " ".join(f"{c}{self.value(self.number())}" for c in chosen)

    def offsets(self) -> list[str]:
        kind = self.rng.randrange(10)
        if kind in (3, 5, 9) and not self.turned:
            self.shifted = True
            axes = f"A{self.number(-40, 40)}" if kind == 9 else self.words_of_axes()
            return [f"G{52 if kind == 5 else 92} {axes}"]
        if kind == 0:
            return [f"G{self.rng.choice(SYSTEMS)}"]
        if kind == 1:
            turn = ""
            if self.plane == 17 and not self.shifted and self.rng.random() < 0.3:
                turn, self.turned = f" R{self.number(-90, 90)}", True
            return [f"G10 L2 P{self.rng.randint(0, 9)} {self.words_of_axes()}{turn}"]
        if kind == 2:
            return [f"G10 L20 P{self.rng.randint(0, 9)} {self.words_of_axes()}"]
        if kind == 4:
            return [self.rng.choice(["G92.1", "G92.2", "G92.3"])]
        if kind == 6 and self.absolute and self.mode != 93:
            return [f"G53 {self.rng.choice(['G0', 'G1'])} {self.words_of_axes()}"]
        if kind == 7:
            return [f"{self.rng.choice(['G28', 'G30'])} {self.rng.choice(['', self.words_of_axes()])}"]
        if kind == 8:
            return [self.rng.choice(["G28.1", "G30.1"])]
        return []

    # --- Control flow ---

    def inner(self, count: int) -> list[str]:
        """Blocks that leave modes as they were, so that what follows them is sound however often they run."""
        before = (self.plane, self.absolute, self.mode)
        out: list[str] = []
        for _ in range(count):
            out += [self.rng.choice([self.line, self.line, self.arc])()]
        assert before == (self.plane, self.absolute, self.mode)
        return out

    def flow(self) -> list[str]:
        self.label += 1
        label, body, times = self.label, self.inner(self.rng.randint(1, 3)), self.rng.randint(0, 3)
        kind = self.rng.randrange(5)
        if kind == 0:
            return [f"o{label} repeat [{times}]", *body, f"o{label} endrepeat"]
        if kind == 1:
            word = self.rng.choice(["", "break", "continue"])
            self.broke |= word == "break"
            stop = [f"o{label}1 if [#{label} EQ 2]", f"o{label} {word}", f"o{label}1 endif"] if word else []
            return [
                f"#{label} = 0",
                f"O{label} while [#{label} LT {times}]",
                f"#{label} = [#{label} + 1]",
                *body,
                *stop,
                *self.inner(1),
                f"o{label} endwhile",
            ]
        if kind == 2 and not self.broke:
            count = f"#{label} = [#{label} + 1]"
            return [f"#{label} = 0", f"o{label} do", *body, count, f"o{label} while [#{label} LT {times}]"]
        if kind == 3:
            return [
                f"o{label} if [{times} GT 1]",
                *body,
                f"o{label} elseif [{times} EQ 1 AND 1]",
                *self.inner(1),
                f"o{label} else",
                *self.inner(1),
                f"o{label} endif",
            ]
        self.label += 1
        return [
            f"o100 call [{self.number()}] [{self.number()}]",
            "G0 X#<_value> Z[#<_value_returned> + #<_gl>]",
            "o<named> call [2]",
        ]

    def subroutines(self) -> list[str]:
        return [
            "o100 sub",
            "#<local> = [#1 + #2] #30 = 7",
            "G0 X#1 Y#<local>",
            "o101 if [#1 GT 0]",
            "o100 return [#1 * 2]",
            "o101 endif",
            "Z#30",
            "o100 endsub [#2]",
            "o<Named> sub",
            "M73",
            "G91 G20",
            "G0 X.25 Y#1",
            "o102 if [#1 GT 0]",
            "o<named> call [#1 - 1]",
            "o102 endif",
            "o<named> endsub",
        ]

    def program(self) -> str:
        rng = self.rng
        out = [*rng.choice([["%"], ["(a program)", ""]]), "G21 G90 G17 G94 G54 F200 S500"]
        out += ["#<_gl> = 3", *self.subroutines()]
        parts: list[tuple[int, Callable[[], list[str]]]] = [
            (6, lambda: [self.line()]),
            (4, lambda: [self.arc()]),
            (2, self.cycle),
            (3, self.modes),
            (3, self.offsets),
            (2, self.flow),
            (1, lambda: [f"#{rng.randint(100, 110)} = {self.value(self.number())} #<q{rng.randint(0, 3)}> = 1"]),
            (1, lambda: ["/G0 X999"]),
            (1, lambda: ["", "; a comment"]),
        ]
        for _ in range(rng.randint(3, 25)):
            (part,) = rng.choices([p for _, p in parts], [w for w, _ in parts])
            out += part()
            if self.mode == 95 and "S500" not in out:
                out.append("S500")
        numbered = rng.random() < 0.2
        if numbered:
            out = [f"N{k} {line}" if line and line[0] not in "%/o" else line for k, line in enumerate(out)]
        return "\n".join([*out, "M2" if out[0] != "%" or rng.random() < 0.5 else "%"]) + "\n"
