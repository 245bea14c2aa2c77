"""Least squares for a pen's motors, friction and weights from recorded sweeps, with the covariance of the result.

A joint in motion obeys, with every torque divided by its gear ratio so that it is at the motor,

    K i = c sgn(q') + v q' + (g w(q) + I q'' + m J_m' r'' + j J_a' a'' / |a|² − J_h' f + λ s) / ratio

K, c, v are the motor's torque constant, Coulomb and viscous friction; g is the moment of the weight, w is sin θ2 or
cos θ3, I the joint's inertia, m and j the grip's mass and inertia, r its middle, a the vector between its ends, f the
force of a hung weight, λ the unknown tension in the grip and s the gradient of the grip's length. Projecting on the
five directions perpendicular to s removes λ. The remaining equations are linear in 30 unknowns; f is the only known
term, so the hung weight alone sets the scale of all unknowns.

Counts and currents pass the same low-pass filter, whose derivatives give speeds and accelerations. The filter does not
bias linear terms, but it biases products: the mean of λ s over the filter's length is not the mean of λ times that of
s. Dry friction, which reverses λ with the speed, made that difference look like 2 % of the viscous friction. So a
narrow filter comes before all products and the projection, and the rest of the filter after them. The currents in a
report act from three quarters of a period before its counts to a quarter after them; a shift of half a millisecond
would look like a tenth of the viscous friction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import pen

GRAVITY = 9.80665  # m/s²
LOCAL_GRAVITY = 0.0015  # relative standard uncertainty: 9.78 m/s² at the equator, 9.83 at the poles
JOINTS = ("R1", "R2", "R3", "L1", "L2", "L3")  # in the order of PenGeometry.joints
UNKNOWNS = 30  # K, c, v of six channels, g of four joints, I of six, m and j
COLUMNS = UNKNOWNS + 2 + 6  # of _equations
WIDTH = 0.013  # s: standard deviation of the low-pass filter
NARROW = 0.003  # s: of its first part, which comes before all products of two filtered values
REACH = 3  # half length of the filter, in units of WIDTH
EVERY = 10  # samples between two rows of the fit
# Periods by which the mean time of a reported current precedes the counts of its report, and the standard uncertainty:
# the pen takes a host's command in its first turn after a frame (docs/device.md), and an amplifier takes some time.
LEAD, LEAD_ERROR = 0.25, 0.1
QUIETEST = 0.5  # times the median residual of its kind: a sweep with less noise gets the weight of this noise
STUCK = 2.0  # times the median residual of its kind: beyond it a joint stuck in a sweep, which is left out
MODEL_ERROR = 0.001  # relative standard uncertainty: noise of counts and currents in the unknowns' own columns
# Lowest usable speed of every joint, rad/s. Slower joints stick and slip while their filtered speed looks steady: their
# friction is then less than dry friction, which looks like viscous friction in all sweeps. At 0.06 rad/s, the viscous
# friction of L2 was up to 15 % off. Sweeps with the weight use 0.06 all the same: the error is small compared with the
# weight, and 0.1 would drop half of their rows.
SLOWEST, SLOWEST_LOADED = 0.1, 0.06
FEWEST = 20  # sweeps that are needed to judge the scatter of the result
NORMAL = 1.96  # standard uncertainties to each side of a 95 % interval
NAMES = ("torque_constant", "coulomb", "viscous", "gravity")


class IdentifyError(ValueError):
    """The sweeps do not determine the values."""


@dataclass(frozen=True)
class Sweep:
    """One recorded motion between two postures."""

    counts: np.ndarray  # (n, 6) as if homing had preset them
    currents: np.ndarray  # (n, 6) A, applied by the motors
    period: float  # s between two rows
    kind: str = ""  # sweeps of one kind have noise of one size


@dataclass(frozen=True)
class Rows:
    """The equations of a sweep; a sweep that ``equations_of`` cannot use has none."""

    kind: str
    matrix: np.ndarray  # (n, 30)
    side: np.ndarray  # (n,)
    loaded: bool  # with the hung weight


@dataclass(frozen=True)
class Equations:
    """A sweep's equations as the values are, and with one of two uncertain numbers off by its standard uncertainty."""

    rows: Rows
    hooked: Rows  # with the hook elsewhere
    led: Rows  # with a lead larger by ``LEAD_ERROR``


@dataclass(frozen=True)
class HungWeight:
    """The weight that hangs on the grip, with standard uncertainties."""

    mass: float  # kg
    mass_error: float
    hook: float  # mm from the grip's middle towards the tool's tip
    hook_error: float

    @property
    def force(self) -> float:
        """Force of the weight, N."""
        return self.mass * GRAVITY

    @property
    def relative_error(self) -> float:
        """Standard uncertainty of the force: mass and local gravity."""
        return float(np.hypot(self.mass_error / self.mass, LOCAL_GRAVITY))


@dataclass(frozen=True)
class Identified:
    """Values and their standard uncertainties by name of ``NAMES``, (6,) in the device's order of channels."""

    values: dict[str, np.ndarray]
    uncertainty: dict[str, np.ndarray]
    rows: int
    residual: float  # N·mm at the motor, root mean square

    def covers(self, name: str, truth: np.ndarray) -> np.ndarray:
        """Whether the true values lie within the 95 % intervals."""
        return np.abs(self.values[name] - truth) <= NORMAL * self.uncertainty[name]


def identify(
    geometry: pen.PenGeometry, free: Sequence[Sweep], loaded: Sequence[Sweep], weight: HungWeight
) -> Identified:
    """The fit to sweeps without and with the hung weight. IdentifyError if they do not determine all values."""

    force, hook, off = weight.force, weight.hook, weight.hook + weight.hook_error
    unloaded = [equations_of(geometry, s, 0.0, hook, hook) for s in free]  # without a weight, its hook is in none
    pulled = [equations_of(geometry, s, force, hook, off) for s in loaded]
    both = [*unloaded, *pulled]
    values, scatter, rows, residual = _fitted([e.rows for e in both])
    hooked, *_ = _fitted([e.hooked for e in both], scatter=False)
    led, *_ = _fitted([e.led for e in both], scatter=False)
    errors = np.sqrt(
        scatter**2
        + (hooked - values) ** 2
        + (led - values) ** 2
        + (weight.relative_error * values) ** 2
        + (MODEL_ERROR * values) ** 2
    )
    return Identified(_by_name(geometry, values), _by_name(geometry, errors), rows, residual)


def _by_name(geometry: pen.PenGeometry, unknowns: np.ndarray) -> dict[str, np.ndarray]:
    gravity = np.zeros(6)
    gravity[_weighted(geometry)] = unknowns[18:22]
    return dict(zip(NAMES, [unknowns[:6], unknowns[6:12], unknowns[12:18], gravity], strict=True))


def _weighted(geometry: pen.PenGeometry) -> list[int]:
    """Channels of joints that the weight turns: all but joints 1, whose axes are vertical."""
    return [k for k, c in enumerate(geometry.channels) if c.name[1] != "1"]


def _fitted(parts: Sequence[Rows], scatter: bool = True) -> tuple[np.ndarray, np.ndarray, int, float]:
    """Unknowns, their standard uncertainties by the jackknife over sweeps, rows, and the residual."""
    parts = [part for part in parts if len(part.side)]
    if len(parts) < FEWEST or not any(part.side.any() for part in parts):
        raise IdentifyError(
            f"only {len(parts)} sweeps have all joints in motion, {FEWEST} are needed, some of them with the weight: "
            "the grip was held, or the motors did not move it"
        )
    scale = 1 / np.sqrt(sum((part.matrix**2).sum(axis=0) for part in parts) + 1e-300)
    squares = np.array([(part.matrix * scale).T @ (part.matrix * scale) for part in parts])
    sides = np.array([(part.matrix * scale).T @ part.side for part in parts])
    kinds, loaded_kinds = np.array([part.kind for part in parts]), {part.kind for part in parts if part.loaded}
    shares, left = np.ones(len(parts)), [part.side for part in parts]
    normal, side, unknowns = solved(shares, squares, sides)
    for _ in range(6):  # each sweep's noise sets its weight in the sum; loaded sweeps share one noise
        left = [part.side - part.matrix @ (scale * unknowns) for part in parts]
        noise = np.array([np.sqrt(np.mean(part**2)) for part in left])
        for kind in set(kinds):
            mine = kinds == kind
            usual = float(np.median(noise[mine]))
            counts_as = np.full(int(mine.sum()), usual)
            if kind not in loaded_kinds:
                counts_as = np.maximum(noise[mine], QUIETEST * usual)
            shares[mine] = np.where(noise[mine] > STUCK * usual, 0.0, counts_as**-2.0)
        normal, side, unknowns = solved(shares, squares, sides)
    residual = float(np.sqrt(np.mean(np.concatenate(left) ** 2)))
    rows = sum(len(part.side) for part in parts)
    if not scatter:
        return unknowns * scale, np.zeros(UNKNOWNS), rows, residual
    # Residuals within a sweep are correlated, so the scatter is judged between sweeps.
    used = shares > 0
    n = int(used.sum())
    without = np.array(
        [
            np.linalg.solve(normal - w * a, side - w * b)
            for w, a, b in zip(shares[used], squares[used], sides[used], strict=True)
        ]
    )
    errors = np.sqrt((n - 1) / n * ((without - without.mean(axis=0)) ** 2).sum(axis=0))
    return unknowns * scale, errors * scale, rows, residual


def solved(shares: np.ndarray, squares: np.ndarray, sides: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The normal equations of the weighted sum of all sweeps, and their solution."""
    normal, side = np.tensordot(shares, squares, 1), shares @ sides
    if np.linalg.cond(normal) > 1e10:
        raise IdentifyError(
            "the sweeps do not tell all values apart: the weight does not hang at the tool's tip, or the grip does "
            "not lean"
        )
    return normal, side, np.linalg.solve(normal, side)


def low_pass(period: float, width: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Weights of a Gaussian low-pass filter of the standard deviation ``width``, and of its first and second derivative
    by time."""
    half = int(np.ceil(REACH * width / period))
    t = np.arange(-half, half + 1) * period
    value = np.exp(-0.5 * (t / width) ** 2)
    value /= value.sum()
    slope = t * value
    slope /= (t * slope).sum()
    curve = (t**2 - width**2) * value
    curve -= curve.mean()
    curve /= 0.5 * (t**2 * curve).sum()
    return value, slope, curve


def filtered(samples: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    """The weighted sums over the first axis of (n, …) samples; shorter than these by the kernel's length minus one."""
    flat = samples.reshape(len(samples), -1)
    out = np.stack([np.convolve(column, kernel[::-1], "valid") for column in flat.T], axis=1)
    return out.reshape(len(out), *samples.shape[1:])


def _usable(angles: np.ndarray, period: float, slowest: float) -> np.ndarray:
    """Indices of (n, 6) angles around which, for a filter's length, every joint keeps turning in one direction."""
    _, slope, _ = low_pass(period, WIDTH)
    half = len(slope) // 2
    if len(angles) <= 4 * half + 1:
        return np.zeros(0, int)
    rates = filtered(angles, slope)
    at = [rates[k : len(rates) - 2 * half + k] for k in (0, half // 2, half, half + half // 2, 2 * half)]
    fast = np.minimum.reduce([np.abs(r) for r in at]) > slowest
    one_way = np.abs(sum(np.sign(r) for r in at)) == len(at)
    return np.flatnonzero((fast & one_way).all(axis=1))[::EVERY] + 2 * half


def equations_of(
    geometry: pen.PenGeometry, sweep: Sweep, force: float, hook: float, off: float, lead: float = LEAD
) -> Equations:
    """Equations of a sweep. ``force``: of the hung weight, N; ``hook``: its distance from the grip's middle towards the
    tool's tip, mm; ``off``: another such distance, that of ``Equations.hooked``."""
    matrix, side, loaded = np.zeros((0, UNKNOWNS)), np.zeros(0), force > 0
    centre = _usable(geometry.joints(sweep.counts), sweep.period, SLOWEST_LOADED if loaded else SLOWEST)
    if not len(centre):
        none = Rows(sweep.kind, matrix, side, loaded)
        return Equations(none, none, none)
    equations, gradient, first = _equations(geometry, sweep, force, (hook, off), lead)
    rest, _, _ = low_pass(sweep.period, np.sqrt(WIDTH**2 - NARROW**2))
    samples, half = equations.reshape(len(equations), -1), len(rest) // 2
    flat = np.array([rest @ samples[at - half : at + half + 1] for at in centre - first])
    basis = square_to(gradient[centre - first])
    out = np.einsum("nkj,nkp->njp", basis, flat.reshape(len(centre), 6, COLUMNS)).reshape(-1, COLUMNS)
    matrix, side, late = out[:, :UNKNOWNS], out[:, UNKNOWNS], out[:, :UNKNOWNS].copy()
    late[:, :6] += out[:, UNKNOWNS + 2 :]
    return Equations(
        Rows(sweep.kind, matrix, side, loaded),
        Rows(sweep.kind, matrix, out[:, UNKNOWNS + 1], loaded),
        Rows(sweep.kind, late, side, loaded),
    )


def _equations(
    geometry: pen.PenGeometry, sweep: Sweep, force: float, hooks: tuple[float, float], lead: float
) -> tuple[np.ndarray, np.ndarray, int]:
    """The six joints' equations at each sample, (n, 6, 38) without a part along the gradient of the grip's length; that
    gradient, (n, 6); and the number of the first of these samples. Behind the unknowns' columns stand the known side
    for each hook, and what a lead larger by ``LEAD_ERROR`` adds to the first six."""
    value, slope, curve = low_pass(sweep.period, NARROW)
    first = len(value) // 2
    counts = sweep.counts[first : len(sweep.counts) - first]
    angles, ends = geometry.joints(sweep.counts), geometry.ends(sweep.counts)
    mean, rates, bends = (filtered(angles, kernel) for kernel in (value, slope, curve))
    speeding, amperes = filtered(ends, curve), filtered(sweep.currents, value + lead * sweep.period * slope)
    later = filtered(sweep.currents, LEAD_ERROR * sweep.period * slope)
    n, ends = len(counts), ends[first : first + len(counts)]

    arms = np.moveaxis(geometry.jacobian(counts), 1, 2)  # (n, xyz, arm, θ)
    middle = 0.5 * arms.reshape(n, 3, 6)
    apart = np.concatenate([-arms[:, :, 0], arms[:, :, 1]], axis=2)
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)[:, None]
    of_middle, of_apart = speeding.mean(axis=1), speeding[:, 1] - speeding[:, 0]
    order = [JOINTS.index(c.name) for c in geometry.channels]
    ratio = np.array([c.ratio for c in geometry.channels])
    by_joint = np.empty(6)
    by_joint[order] = ratio
    matrix = np.zeros((n, 6, COLUMNS))
    for k, (joint, c) in enumerate(zip(order, geometry.channels, strict=True)):
        matrix[:, joint, k] = c.sign * amperes[:, k]
        matrix[:, joint, UNKNOWNS + 2 + k] = c.sign * later[:, k]
        matrix[:, joint, 6 + k] = -np.sign(rates[:, joint])
        matrix[:, joint, 12 + k] = -rates[:, joint] * ratio[k]
    for g, k in enumerate(_weighted(geometry)):
        turn = mean[:, order[k]]
        lying = np.sin(turn) if geometry.channels[k].name[1] == "2" else np.cos(turn)
        matrix[:, order[k], 18 + g] = -lying / ratio[k]
    for joint in range(6):  # 1e-3: kg·mm² to N·mm·s²
        matrix[:, joint, 22 + joint] = -1e-3 * bends[:, joint] / by_joint[joint]
    matrix[:, :, 28] = -1e-3 * np.einsum("nxk,nx->nk", middle, of_middle) / by_joint
    matrix[:, :, 29] = -1e-3 * np.einsum("nxk,nx->nk", apart, of_apart) / length**2 / by_joint
    for k, hook in enumerate(hooks):
        towards_tip = (1.0 if geometry.tip == "L" else -1.0) * hook / length
        # A weight on a thread follows vertical motion only. Its swinging averages out over a sweep.
        rising = of_middle[:, 2] + (towards_tip * of_apart)[:, 2]
        down = -force * (1 + 1e-3 * rising / GRAVITY)
        matrix[:, :, UNKNOWNS + k] = -(middle[:, 2] + towards_tip * apart[:, 2]) * down[:, None] / by_joint

    gradient = np.einsum("nxk,nx->nk", apart, along / length) / by_joint
    unit = gradient / np.linalg.norm(gradient, axis=1)[:, None]
    matrix -= unit[:, :, None] * np.einsum("nk,nkp->np", unit, matrix)[:, None, :]
    return matrix, gradient, first


def square_to(vectors: np.ndarray) -> np.ndarray:
    """(n, 6, 5): orthonormal columns perpendicular to each of (n, 6) vectors, by Householder's reflection."""
    mirror = vectors / np.linalg.norm(vectors, axis=1)[:, None]
    mirror[:, 0] += np.where(mirror[:, 0] < 0, -1.0, 1.0)
    mirror /= np.linalg.norm(mirror, axis=1)[:, None]
    return (np.eye(6) - 2 * mirror[:, :, None] * mirror[:, None, :])[:, :, 1:]
