"""Millimetres and Blender units, and the text form of sizes."""

from __future__ import annotations

import math


def clean(value: float) -> float:
    """The decimal number that was entered: Blender's properties are float32 with seven digits (0.001 reads
    0.0010000000474974513)."""
    return float(f"{value:.7g}")


def mm_per_unit(scale_length: float) -> float:
    """Millimetres in one Blender unit."""
    if not (math.isfinite(scale_length) and scale_length > 0):
        raise ValueError(f"scale_length must be positive, not {scale_length}")
    return clean(scale_length * 1000.0)


def trim(value: float, digits: int = 3) -> str:
    """A number with at most `digits` decimals and no trailing zeros."""
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".") if digits else f"{value:.0f}"
    return "0" if text in ("-0", "") else text


def format_size(size, digits: int = 2) -> str:
    """(100, 60, 30) → "100 × 60 × 30 mm"."""
    return " × ".join(trim(float(s), digits) for s in size) + " mm"


def format_count(n: int) -> str:
    """12345678 → "12 345 678"."""
    return f"{int(n):,}".replace(",", "\u00a0")


def counted(n: int, one: str) -> str:
    """ "1 move", "12 345 moves"."""
    return f"{format_count(n)} {one}{'' if n == 1 else 's'}"


def format_bytes(n: float) -> str:
    for unit in ("bytes", "KB", "MB", "GB", "TB"):
        if n < 999.5 or unit == "TB":
            break
        n /= 1000
    return f"{n:.0f} {unit}" if unit == "bytes" or n >= 100 else f"{n:.1f} {unit}"


def format_volume(mm3: float) -> str:
    """Cubic millimetres below a thousand, cubic centimetres above."""
    return f"{trim(mm3, 2)} mm³" if abs(mm3) < 1000 else f"{trim(mm3 / 1000, 2)} cm³"
