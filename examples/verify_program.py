"""Check an NC program before a machine runs it: rapids in material, gouges, rest material, each with its source line.

Shows: Program.read, verify, VerifyReport.findings and VerifyReport.stock_deviation.
"""

from pathlib import Path

import riffler
from picture import View, plt, save

# A pocket 6 mm deep in rows 4 mm apart. Two mistakes: one row is 0.4 mm too deep, one rapid crosses the pocket's wall.
code = ["G21 G90 G94", "T1 M6", "S9000 M3", "G0 X15 Y15 Z25", "G1 Z14 F300"]
for number, y in enumerate(range(15, 36, 4)):
    depth = 13.6 if number == 3 else 14
    ends = (15, 45) if number % 2 == 0 else (45, 15)
    code += [f"G1 X{ends[0]} Y{y} Z{depth} F800", f"G1 X{ends[1]} Y{y} Z{depth}"]
code += ["G0 X70 Y35", "G0 Z25", "M5", "M30"]
Path("pocket.ngc").write_text("\n".join(code) + "\n")

# The part: the block without the pocket, which is what a flat cutter of 10 mm leaves of it.
tool = riffler.Tool.flat(10, 20)
stock = riffler.Volume.block((0, 0, 0), (60, 50, 20), 0.5, "xyz")
part = stock.copy()
for y in range(15, 36):
    part.carve(tool, [[15, y, 14, 0, 0, 1], [45, y, 14, 0, 0, 1]])

program = riffler.Program.read("pocket.ngc", machine="tcp")
report = riffler.verify(program, stock, part.to_mesh(), tools={1: tool}, rest_tolerance=0.2)
print("passed" if report.passed else "NOT passed")
for finding in report.findings:
    where = f"line {finding.line} ({code[finding.line - 1]})" if finding.line else "at the end"
    print(f"  {finding.kind}, {where}: {finding.value:.3f} {finding.unit}")

measured = report.stock_deviation()
assert measured is not None  # there is a part
mesh, distance = measured  # mm at each vertex: above 0 rest material, below 0 gouged
figure, ax = plt.subplots(figsize=(7, 4.6))
view = View(mesh, azimuth=-60, elevation=55)
scale = view.show(ax, values=view.values(mesh, distance), limits=(-0.5, 0.5))
for k, finding in enumerate(report.findings):
    text = f"{finding.kind}, line {finding.line}" if finding.line else finding.kind
    view.label(ax, finding.point, text, away=(0, 34 + 16 * k))
figure.colorbar(scale, ax=ax, shrink=0.7, label="mm: red gouged, blue rest material")
ax.set_title("What the program leaves, compared with the part", loc="left")
save(figure, "verify_program.png")
