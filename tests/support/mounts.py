"""Engine files with a body on mounts, and the same body by formulas of the tests' own."""

import numpy as np

from .engines import changed

ENGINE = changed(
    *(("in-line four", "four"), ("throw_mass = 0.8", "throw_mass = 0.7"), ("length = 160", "length = 150")),
    *(("cg = 45", "cg = 42\ninertia = 2500"), ("bore = 86", "bore = 80")),
    ("[layout]\nfiring_order = [1, 3, 4, 2]", "[cylinder.2]\npiston_mass = 0.55"),
)
BLOCK = """
[body]
mass = 200
cg = [0, 0, 0]
inertia = [8e6, 12e6, 14e6, 0, 0, 0]
gravity = [0, 0, -1]
"""


def block(extra: str = "", count: int = 4) -> str:
    """A block on up to four equal mounts, by whose closed forms it is known."""
    corners = [(400, 300), (400, -300), (-400, 300), (-400, -300)][:count]
    mounts = (
        f'[[mount]]\nname = "{k}"\nat = [{x}, {y}, -200]\nstiffness = [200, 150, 400]\n{extra}\n'
        for k, (x, y) in enumerate(corners, 1)
    )
    return BLOCK + "".join(mounts)


class RandomBody:
    """A body with a full tensor on turned mounts.

    Attributes:
        text: as an engine file says it.
        mass: (6, 6) M. stiffness: (6, 6) K, complex, dynamic. static: (6, 6).
        centre: (3,) m. at: (mounts, 3) m. point: (3,) m.
        each: (mounts, 3, 3) complex stiffness of every mount along the engine's axes.
        damping: (6, 6).
    """

    def __init__(self, seed: int, mounts: int, loss: float = 0.1, damping: float = 0.0) -> None:
        rng = np.random.default_rng(seed)
        root = rng.normal(size=(3, 3)) + 3 * np.eye(3)
        tensor = root @ root.T
        self.centre = rng.uniform(-0.1, 0.1, 3)
        kilograms = float(rng.uniform(50, 200))
        self.mass = np.zeros((6, 6))
        self.mass[:3, :3] = kilograms * np.eye(3)
        self.mass[3:, 3:] = tensor
        self.point = rng.uniform(-0.5, 0.5, 3)
        elements = [tensor[i, j] * 1e6 for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))]
        self.text = (
            f"[body]\nmass = {kilograms!r}\ncg = {(1e3 * self.centre).tolist()}\n"
            f"inertia = {[float(e) for e in elements]}\n"
            f'[[point]]\nname = "p"\nat = {(1e3 * self.point).tolist()}\n'
        )
        self.stiffness = np.zeros((6, 6), complex)
        self.static = np.zeros((6, 6))
        self.damping = np.zeros((6, 6))
        self.at = []
        self.each = []
        for k in range(mounts):
            self._add_mount(rng, k, loss, damping)

    def _add_mount(self, rng, k: int, loss: float, damping: float) -> None:
        at = rng.uniform(-0.5, 0.5, 3)
        springs = rng.uniform(1e5, 5e5, 3)
        factor = float(rng.uniform(1, 1.5))
        if k % 2:
            a, b, c = rng.uniform(-180, 180, 3)
            own = turn(2, c) @ turn(1, b) @ turn(0, a)
            said = f"angles = {[float(a), float(b), float(c)]}"
        else:
            one, other = rng.normal(size=(2, 3))
            two = np.cross(one, other)
            own = np.stack([one, two, np.cross(one, two)])
            own = (own / np.linalg.norm(own, axis=1)[:, None]).T
            said = f"axes = [{one.tolist()}, {two.tolist()}]"
        self.text += (
            f'[[mount]]\nname = "m{k}"\nat = {(1e3 * at).tolist()}\n{said}\n'
            f"stiffness = {(springs / 1e3).tolist()}\nloss = {loss}\ndynamic_factor = {factor!r}\n"
            f"damping = {[damping] * 3}\n"
        )
        each = own @ np.diag(springs) @ own.T
        arm = at - self.centre
        skew = np.array([[0, -arm[2], arm[1]], [arm[2], 0, -arm[0]], [-arm[1], arm[0], 0]])
        self.static += self._place(each, skew)
        self.stiffness += factor * (1 + 1j * loss) * self._place(each, skew)
        self.damping += damping * 1e3 * self._place(np.eye(3), skew)
        self.at.append(at)
        self.each.append(factor * (1 + 1j * loss) * each)

    @staticmethod
    def _place(each, skew):
        """Of a spring (3, 3) at an arm about the centre: block by block."""
        return np.block([[each, -each @ skew], [skew @ each, -skew @ each @ skew]])


def turn(axis: int, degrees: float):
    """A rotation about one axis."""
    c = np.cos(np.radians(degrees))
    s = np.sin(np.radians(degrees))
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    result = np.eye(3)
    result[i, i] = result[j, j] = c
    result[j, i] = s
    result[i, j] = -s
    return result
