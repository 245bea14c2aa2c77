"""The plots and tables of docs/stability.md: theory and simulation, by riffler_stability.

cmake --build --preset release --target riffler_stability
python docs/gallery/stability.py
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]
DOCUMENT = ROOT / "docs" / "stability.md"
OUT = ROOT / "docs" / "images" / "stability.png"
PROGRAM = ROOT / "build" / "release" / "native" / "stress" / "riffler_stability"


def table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def pen_table(rows: list[dict]) -> str:
    return table(
        ["where", "step Δ, mm", "2b/T, N/mm", "2f/Δ, N/mm", "bound, N/mm"],
        [
            [r["place"], f"{r['step']:.4f}", f"{r['sampling']:.2f}", f"{r['quantisation']:.1f}",
             f"{min(r['sampling'], r['quantisation']):.2f}"]
            for r in rows
        ],
    )  # fmt: skip


def agreement_table(data: dict) -> str:
    """Largest deviation of a simulated boundary from the bound, by kind."""

    def worst(rows: list[dict], key: str) -> str:
        deviations = [r[key] / r["bound"] - 1 for r in rows]
        low, high = (round(100 * d, 2) + 0.0 for d in (min(deviations), max(deviations)))
        return f"{low:.2f} … {high:.2f} %"

    positive = [r for r in data["wall_damping"] if r["wall_damping"] >= 0]
    negative = [r for r in data["wall_damping"] if r["wall_damping"] < 0]
    return table(
        ["bound", "simulated hand", "boundaries", "off the bound by"],
        [
            ["2b/T, one coordinate", "lets go", str(len(data["sampling"])), worst(data["sampling"], "swing")],
            ["2b/T, one coordinate", "cunning", str(len(data["sampling"])), worst(data["sampling"], "cunning")],
            ["2(b − B)/T, B ≥ 0", "cunning", str(len(positive)), worst(positive, "cunning")],
            ["2(b + B)/T, B < 0", "cunning", str(len(negative)), worst(negative, "cunning")],
            ["min(2b/T, 2f/Δ)", "cunning", str(len(data["quantisation"])), worst(data["quantisation"], "cunning")],
            ["2/(T nᵀD⁻¹n), five coordinates", "guides", str(len(data["five"])), worst(data["five"], "guided")],
            ["2/(T nᵀD⁻¹n), five coordinates", "cunning", str(len(data["five"])), worst(data["five"], "cunning")],
            ["2/(T nᵀD⁻¹n), five coordinates", "lets go", str(len(data["five"])), worst(data["five"], "free")],
        ],
    )


def session_table(data: dict) -> str:
    rows = []
    for times in (0.5, 0.9, 1.1, 2.0, 8.0, 30.0, 100.0):
        cells = [f"{times:g}"]
        for name in ("one_session", "five_session"):
            r = next(r for r in data[name] if r["times"] == times)
            for key in ("off", "on"):
                cells += [f"{r[key]['gained']:.2f}", f"{r[key]['speed']:.2f}"]
            cells.append(f"{r['on']['depth']:.3f}")
        rows.append(cells)
    head = ["K ÷ bound"]
    for name in ("one", "five"):
        for key in ("off", "on"):
            head += [f"{name}, {key}: gained, N·mm", "mm/s"]
        head.append("depth, mm")
    return table(head, rows)


def hardness_table(data: dict) -> str:
    rows = []
    for times in (0.25, 0.5, 1.0, 2.0, 5.0, 15.0, 30.0, 100.0):
        cells = [f"{times:g}"]
        for name in ("one_session", "five_session"):
            r = next(r for r in data[name] if r["times"] == times)
            cells += [f"{r['stiffness']:.2f}", f"{r['off']['hardness']:.2f}", f"{r['on']['hardness']:.2f}"]
        rows.append(cells)
    head = ["K ÷ bound"]
    for name in ("one", "five"):
        head += [f"{name}: K, N/mm", "H off", "H on"]
    return table(head, rows)


def touched_table(rows: list[dict]) -> str:
    return table(
        ["K, N/mm", "nothing credited", "half", "all"],
        [[f"{r['stiffness']:g}", str(r["none"]), str(r["half"]), str(r["all"])] for r in rows],
    )


def fill(tables: dict[str, str]) -> None:
    text = DOCUMENT.read_text()
    for name, rows in tables.items():
        pattern = re.compile(rf"(<!-- stability {name} -->\n)(.*?)(<!-- end -->)", re.DOTALL)
        text, count = pattern.subn(lambda m, rows=rows: m[1] + rows + m[3], text)
        if count != 1:
            raise SystemExit(f"{DOCUMENT.name}: {count} places for the table {name}")
    DOCUMENT.write_text(text)


def draw(data: dict) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure, ((sampling, steps), (five, energy)) = plt.subplots(2, 2, figsize=(10.5, 8.4), dpi=100)

    b = [1e3 * r["damping"] for r in data["sampling"]]
    sampling.plot([0, 3.2], [0, 6.4], "k-", lw=1, label="2b/T")
    sampling.plot(b, [r["swing"] for r in data["sampling"]], "o", mfc="none", ms=9, label="let go: swings up above")
    sampling.plot(b, [r["cunning"] for r in data["sampling"]], "x", label="cunning hand: gains above")
    walls = data["wall_damping"]
    inset = sampling.inset_axes((0.58, 0.12, 0.4, 0.36))
    inset.plot([1e3 * r["wall_damping"] for r in walls], [r["bound"] for r in walls], "k-", lw=1)
    inset.plot([1e3 * r["wall_damping"] for r in walls], [r["cunning"] for r in walls], "C1x")
    inset.set_title("b = 2, over the wall's B", fontsize=8)
    inset.tick_params(labelsize=7)
    sampling.set(xlabel="damping b, N·s/m", ylabel="K, N/mm", title="Sampling: Colgate and Schenkel", xlim=(0, 3.2))
    sampling.set_ylim(0, 6.8)
    sampling.legend(loc="upper left", fontsize=8, frameon=False)

    rows = data["quantisation"]
    grid = [0.004 * 1.05**k for k in range(95)]
    steps.plot(grid, [min(4.0, 0.4 / s) for s in grid], "k-", lw=1, label="min(2b/T, 2f/Δ)")
    steps.plot([r["step"] for r in rows], [r["cunning"] for r in rows], "C1x", label="cunning hand: gains above")
    steps.axvline(0.0236, color="0.7", lw=1)
    steps.text(0.0236, 0.4, " pen, end of an arm", color="0.4", fontsize=8)
    steps.set(xscale="log", xlabel="encoder step Δ, mm", ylabel="K, N/mm", ylim=(0, 4.8), xlim=(0.004, 0.4),
              title="Quantisation: Abbott and Okamura (b = 2 N·s/m, f = 0.2 N)")  # fmt: skip
    steps.title.set_fontsize(10)
    steps.legend(loc="lower left", fontsize=8, frameon=False, bbox_to_anchor=(0, 0.12))

    bounds = [r["bound"] for r in data["five"]]
    five.plot([0, 8], [0, 8], "k-", lw=1, label="2/(T nᵀD⁻¹n)")
    five.plot(
        bounds, [r["guided"] for r in data["five"]], "o", mfc="none", ms=9, label="hand that guides: swings up above"
    )
    five.plot(bounds, [r["cunning"] for r in data["five"]], "x", label="cunning hand: gains above")
    five.plot(bounds, [r["free"] for r in data["five"]], "^", ms=5, label="let go: swings up above")
    five.set(xlabel="bound, N/mm", ylabel="simulated boundary, N/mm", title="Five coordinates, coupled",
             xlim=(0.6, 2.8), ylim=(0, 8))  # fmt: skip
    five.legend(loc="upper right", fontsize=8, frameon=False)

    for name, colour, text in (("one_session", "C0", "one"), ("five_session", "C3", "five")):
        times = [r["times"] for r in data[name]]
        energy.plot(times, [r["off"]["gained"] for r in data[name]], "o-", color=colour, ms=4, label=f"{text}, off")
        energy.plot(times, [r["on"]["gained"] for r in data[name]], "s--", color=colour, mfc="none", ms=4,
                    label=f"{text}, on")  # fmt: skip
    energy.axhline(1, color="k", lw=1)
    energy.text(12, 1.08, "reserve", fontsize=8)
    energy.axvline(1, color="0.7", lw=1)
    energy.set(xscale="log", xlabel="K ÷ bound", ylabel="most that the hand gained in 20 s, N·mm",
               title="Pressing with 2 N, controller off and on")  # fmt: skip
    energy.set_yscale("symlog", linthresh=1)
    energy.set_ylim(-0.1, 200)
    energy.legend(loc="center left", fontsize=8, frameon=False, bbox_to_anchor=(0, 0.62))

    figure.tight_layout()
    OUT.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(OUT)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=Path, default=PROGRAM, help="riffler_stability, built")
    arguments = parser.parse_args()
    data = json.loads(subprocess.run([arguments.program], check=True, stdout=subprocess.PIPE).stdout)
    draw(data)
    fill(
        {
            "pen": pen_table(data["pen"]),
            "agreement": agreement_table(data),
            "sessions": session_table(data),
            "hardness": hardness_table(data),
            "touched": touched_table(data["touched"]),
        }
    )


if __name__ == "__main__":
    main()
