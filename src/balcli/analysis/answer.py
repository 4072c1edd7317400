"""Analyze an engine: forces and moments by order, peaks, devices, and other results on request."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from functools import reduce
from operator import add
from types import NoneType
from typing import Annotated, Any, Literal

from ..core.cylinders import find_travel
from ..core.phasors import Array, Phasors
from ..core.records import HIDDEN, INLINE, Asked, WrittenAs
from ..engine.engine import Engine, check_engine, refuse_geared, take_model
from ..errors import ArgumentError, BalcliError, check_number, check_type, list_words
from ..file.assumed import Assumed
from ..file.model import EngineFile
from ..forces.crankshaft import InnerLoads, compute_inner_loads
from ..forces.guide import GuideMoments, compute_guide_moments
from ..forces.kinds import EVERY_KIND, FREE, GAS, GAS_KINDS, KINDS, list_with
from ..forces.spectrum import (
    Spectra,
    check_orders,
    choose_orders,
    compute_spectra,
    find_relevant_orders,
    list_gas_orders,
    merge_orders,
)
from ..forces.stars import Star, find_stars
from ..forces.symmetry import Symmetry, explain_symmetry
from ..limits import HIGHEST_GUIDE_M, HIGHEST_ORDER_UNASKED, MOST_RESULTS_BY_CYLINDER, SMALL
from ..show.figures import (
    EngineState,
    OrdersAndPeaks,
    Peaks,
    describe_state,
    find_peaks,
    list_orders,
    measure_engine,
)
from ..show.result import Result
from ..sizing.ladder import Ladder, find_ladder
from ..sizing.options import check_small
from ..sizing.remedy import Remedy, fit_devices
from ..sizing.residual import Scales, find_scales
from ..sizing.room import assume_skirt
from .other_speeds import add_at_most, find_other_speeds
from .parts import find_parts
from .records import (
    BalanceParts,
    BankShare,
    CylinderShare,
    Journal,
    Masses,
    PartAtOtherSpeed,
    PeaksAndOrders,
    PowerRelatedUnbalance,
    Stroke,
    describe_guide,
    describe_inner,
    name_devices,
)
from .verdict import Verdict, judge

UNASKED = (*KINDS, "peak")  # default quantities of every engine
QUANTITIES = (*UNASKED, "sizing", "ladder")
EXTRAS = ("inner", "guide", "journals", "masses", "parts", "pru")  # computed only on request

# Quantities that depend on the default of a file key or table, by the name of this key or table.
_OF_FORCES = {"peak", "sizing", "ladder", "inner", "pru"}
_WITH_THROWS = list_with("throws") | _OF_FORCES
_WITH_PLACES = list_with("planes") | _OF_FORCES | {"guide"}
_WITH_ARMS = list_with("arms")
_PLACES_OF_DEVICES = ("counterweight.position", "shaft.position", "slider.position")
_ALL_BUT_MASSES = {*QUANTITIES, *GAS_KINDS, "inner", "guide", "journals", "pru"}
# "gas" stands for loads with gas, which depend on rods as well.
_WITH_RODS = list_with("rods") | {"gas", "guide", "journals", "masses"}
_OF_FIRING = {"layout.strokes", "layout.firing_intervals"}
_DEPENDENT = {
    "gas": {*GAS_KINDS, "pru"},
    "rod.inertia": _WITH_RODS,
    "articulation.rod.inertia": _WITH_RODS,
    "crank.inertia": list_with("turning"),
    "flywheel.inertia": list_with("turning"),
    **dict.fromkeys(("crank.throws", "piston.offset", *_OF_FIRING), _ALL_BUT_MASSES),
    "layout.stagger": _WITH_PLACES,
    # Forces do not depend on the spacing; its listed default explains why no moments are printed.
    "crank.spacing": _WITH_PLACES | {"force", "journals"},
    "counterweight.angle": _WITH_THROWS | {"parts"},
    **dict.fromkeys(("shaft.angle", "slider.angle"), _WITH_THROWS | _WITH_ARMS | {"parts"}),
    **dict.fromkeys(_PLACES_OF_DEVICES, _WITH_PLACES | {"parts"}),
    **dict.fromkeys(("shaft.at", "slider.at"), _WITH_ARMS | {"parts"}),
}
DEFAULT_ORDERS = (1.0, 2.0)
_OF_CRANK_DRIVE = frozenset(("journals", "masses", "pru"))
_OF_ONE_CRANK = ("inner", "guide", "journals", "masses", "parts")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Analysis(OrdersAndPeaks, Result):
    """Free forces and moments of an engine, order by order, without unrequested results.

    Reading a result that was not requested raises NotComputedError.

    Attributes:
        engine: Analyzed engine.
        state: Speed, which cylinders have no gas, and point of reference of the moments.
        spectra: Orders shown.
        assumed: Values that are used because the engine file leaves them out.
        verdict: What the forces and moments of the orders shown amount to.
        peak: Largest force and moment over a revolution, all orders added up.
        sizing: Devices of the scheme `auto`, the default of `balance`, and the forces and moments
            that remain with them.
        ladder: Devices that balance the engine, step by step.
        cylinders: Forces and moments of each single cylinder, without devices.
        banks: Forces and moments of each single bank, without devices.
        inner: Shear force and bending moment along the crankshaft; for an engine with gas, also
            loads of bearings and block.
        guide: H- and X-type guide-force moments.
        travel: Strokes and dead centres of all cylinders; left out unless rods are articulated or
            the engine is rotary.
        journals: Torque in main journals and crank pins.
        masses: Masses of pistons, rods and throws.
        parts: Bearing loads of balancer shafts and shapes of counterweights.
        other_speeds: Parts without a fixed phase to the crank, such as those behind a belt, which
            are no part of the orders; left out if there are none.
        power_related_unbalance: Free moments divided by the power.
        why: Whether the orders shown are balanced by symmetry or by chance.
        stars: Phasor stars of the cylinders, for the requested orders (default: 1 and 2).
        small: Share of one cylinder's first order. The verdict calls a rotating force or moment
            below this share small.
        whole_roll: Roll by inertia of all computed orders; None if it was not requested.
    """

    format: Literal["balcli.analysis/1"] = "balcli.analysis/1"
    engine: Annotated[Engine, WrittenAs(measure_engine)]
    state: Annotated[EngineState, INLINE]
    spectra: Annotated[Spectra, WrittenAs(list_orders, "orders")]
    assumed: tuple[Assumed, ...] | None = None
    verdict: Asked[Verdict] = Asked('only=["force", "moment"]')
    peak: Asked[Peaks] = Asked('only=["peak"]')
    sizing: Asked[Sizing] = Asked('only=["sizing"]')
    ladder: Asked[Ladder] = Asked('only=["ladder"]')
    cylinders: Asked[tuple[CylinderShare, ...]] = Asked('by="cylinder"')
    banks: Asked[tuple[BankShare, ...]] = Asked('by="bank"')
    inner: Asked[Annotated[InnerLoads, WrittenAs(describe_inner)]] = Asked('only=["inner"]')
    guide: Asked[Annotated[GuideMoments, WrittenAs(describe_guide)]] = Asked('only=["guide"]')
    travel: tuple[Stroke, ...] | None = None
    journals: Asked[tuple[Journal, ...]] = Asked('only=["journals"]')
    masses: Asked[tuple[Masses, ...]] = Asked('only=["masses"]')
    parts: Asked[BalanceParts] = Asked('only=["parts"]')
    other_speeds: tuple[PartAtOtherSpeed, ...] | None = None
    power_related_unbalance: Asked[PowerRelatedUnbalance] = Asked('only=["pru"]')
    why: Asked[Symmetry] = Asked("why=True")
    stars: Asked[tuple[Star, ...]] = Asked("why=True")
    small: Annotated[float, HIDDEN] = SMALL
    whole_roll: Annotated[Phasors | None, HIDDEN] = None

    @property
    def summary(self) -> str:
        """Name of the engine and the orders shown, in words."""
        orders = ", ".join(f"{order:g}" for order in self.orders[:12])
        if len(self.orders) > 12:
            orders += ", ..."
        return f"of {self.engine.summary}; orders {orders}"

    @property
    def orders(self) -> Array:
        """Orders shown, shape (orders,)."""
        return self.spectra.orders

    @property
    def moments_known(self) -> bool:
        """Whether the file gives the positions of the throws. If not, moments are computed as if
        all throws were in one plane.
        """
        return self.engine.places_known

    @property
    def of_one_cylinder(self) -> dict[str, float]:
        """Largest first-order force, moment and roll of one cylinder, by the name of each kind."""
        scales = self.scales
        scalars = [kind.name for kind in KINDS.values() if not kind.vector]
        return dict.fromkeys(scalars, scales.roll) | scales._asdict()

    @property
    def scales(self) -> Scales:
        """Largest first-order force, moment and roll of one cylinder."""
        return find_scales(self.engine)


def shorten(analysis: Analysis) -> PeaksAndOrders:
    """Return only the peaks and orders of an analysis; the peaks must have been computed."""
    return PeaksAndOrders(analysis.peak, analysis.spectra)


@dataclass(frozen=True)
class Sizing:
    """Devices of the scheme `auto`, the default of `balance`, and the forces and moments that
    remain with them.

    Attributes:
        remedy: New devices.
        after: Analysis of the engine with these devices.
    """

    remedy: Annotated[Remedy, WrittenAs(name_devices), INLINE]
    after: Annotated[Analysis, WrittenAs(shorten)]


def analyze(
    engine: Engine,
    orders: Iterable[float] | None = None,
    only: str | Collection[str] | None = None,
    by: Literal["cylinder", "bank"] | None = None,
    why: bool = False,
    guide_height: float | None = None,
    beside: Collection[Engine] = (),
    small: float = SMALL,
) -> Analysis:
    """Return the free forces and moments of an engine, order by order.

    Args:
        engine: One engine, not an array of variants.
        orders: Orders to show; default: 1 and 2 (at uneven speed also 0), and each order up to 512
            at which the amplitude of some quantity exceeds 1e-6 of this quantity's largest
            amplitude at any order.
        only: Any of force, moment, couple, torque, roll, peak, sizing, ladder, inner, guide,
            journals, masses, parts, pru (power related unbalance) and gas, as a list or a text with
            commas; default: the first six (force to peak), and gas if the engine has gas.
        by: "cylinder" or "bank": compute the phasors of each single cylinder or bank as well.
        why: Whether to find out why each order is balanced or not, and to compute phasor stars.
        guide_height: Distance from the crankshaft to the middle of the guides, m, for the X-type
            guide moment; default: the length of each rod.
        beside: Other engines with which the result is to be compared. `orders` may contain half
            orders if `engine` or one of these engines has half orders.
        small: Share of one cylinder's first order. Ladder and sizing leave a rotating force or
            moment below this share unbalanced.

    Raises:
        BalcliError: A quantity is unknown, an order is negative or above 4096, single cylinders
            would give too many results, `guide_height` is not above 0, or `small` is not 0 to 0.5.
        TypeError: An argument has the wrong type.

    Example:
        >>> analyze(load("v8.toml"), orders=[1, 2]).spectra["moment"].major
    """
    wanted = _choose_quantities(check_engine("analyze", engine), only)
    _check_height(guide_height)
    check_small(check_number("small", small, "give a share, such as 0.05"))
    check_type("by", by, (str, NoneType), 'give "cylinder" or "bank"')
    if by not in (None, "cylinder", "bank"):
        raise ArgumentError('{by} {other!r}: give "cylinder" or "bank"', other=by)
    check_type("why", why, bool, "give True or False")
    check_type("beside", beside, Collection, "give engines, such as [engine]")
    for other in beside:
        check_engine("analyze", other)
    if why or by == "bank" or not wanted.isdisjoint(_OF_ONE_CRANK):
        refuse_geared(engine)
    asked = None if orders is None else check_orders(orders, [engine, *beside])
    shown = wanted.intersection(EVERY_KIND)
    of_gas = () if engine.gas is None else list_gas_orders(engine)
    due = DEFAULT_ORDERS if asked is None else asked
    every = merge_orders(find_relevant_orders(engine), of_gas, due)
    computed = every if asked is None or "peak" in wanted else asked
    peaked = set()
    if "peak" in wanted:
        peaked = {kind.name for kind in FREE}
    if engine.gas is None or computed.max() <= HIGHEST_ORDER_UNASKED:
        everything = compute_spectra(engine, computed, shown | peaked)
        visible = everything.only(shown)
    else:  # a rod barely long enough makes tens of thousands of orders, which only peaks need
        few = every[every <= HIGHEST_ORDER_UNASKED] if asked is None else asked
        visible = compute_spectra(engine, few, shown)
        everything = compute_spectra(engine, computed, peaked) if peaked else visible
    visible = visible.select_orders(choose_orders(visible, of_gas) if asked is None else asked)
    has_linkage = engine.cylinders.linkage is not None and not engine.placed
    model = take_model(engine) if "parts" in wanted else None
    provable = shown if engine.places_known else shown - {"moment"}
    others = find_other_speeds(engine)
    ladder = find_ladder(engine, small) if wanted.intersection(("sizing", "ladder")) else None
    return Analysis(
        engine=engine,
        state=describe_state(engine),
        spectra=visible,
        assumed=_list_assumed(engine, wanted, ladder),
        verdict=_judge(engine, visible, small) if visible.vectors() else None,
        peak=add_at_most(find_peaks(everything), others) if peaked else None,
        sizing=_size(engine, ladder, asked, wanted) if ladder and "sizing" in wanted else None,
        ladder=ladder if "ladder" in wanted else None,
        cylinders=_analyze_cylinders(engine, visible.orders, shown) if by == "cylinder" else None,
        banks=_analyze_banks(engine, visible.orders, shown) if by == "bank" else None,
        inner=find_inner_loads(engine, asked) if "inner" in wanted else None,
        guide=compute_guide_moments(engine, asked, guide_height) if "guide" in wanted else None,
        travel=list_strokes(engine) if has_linkage else None,
        why=explain_symmetry(engine, visible.orders, provable) if why else None,
        stars=_find_stars(engine, due, shown) if why else None,
        small=small,
        whole_roll=visible.roll if everything.roll is None else everything.roll,
        **_analyze_crank_drive(engine, wanted),
        other_speeds=others or None,
        parts=_find_own_parts(engine, model) if model else None,
    )


def _analyze_crank_drive(engine: Engine, wanted: Collection[str]) -> dict[str, Any]:
    """Return the wanted results of the crank drive by their attributes."""
    found: dict[str, Any] = {}
    if not _OF_CRANK_DRIVE.isdisjoint(wanted):
        from . import crank_drive  # loads the curves of the gas

        if "pru" in wanted:
            found["power_related_unbalance"] = crank_drive.relate_to_power(engine)
        if "journals" in wanted:
            found["journals"] = crank_drive.find_journals(engine)
        if "masses" in wanted:
            found["masses"] = crank_drive.list_masses(engine)
    return found


def _list_assumed(
    engine: Engine, wanted: Collection[str], ladder: Ladder | None
) -> tuple[Assumed, ...] | None:
    """Return the values that are assumed for the wanted quantities; None if there are none."""
    assumed = engine.list_assumed("gas", without=list_idle_defaults(engine, wanted)) or ()
    steps = ladder.steps if ladder is not None and "ladder" in wanted else ()
    return (*assumed, *assume_skirt(engine, [step.remedy for step in steps])) or None


def _find_own_parts(engine: Engine, model: EngineFile) -> BalanceParts:
    """Return shafts, counterweights, webs and throws of an engine and its file."""
    return find_parts(engine, model.shaft, model.counterweight, throws=True)


def _check_height(guide_height: float | None) -> None:
    if guide_height is None:
        return
    height_m = check_number("guide_height", guide_height, "give a length in m, such as 0.6")
    if not 0 < height_m < HIGHEST_GUIDE_M:
        raise ArgumentError(
            "{guide_height} {height:g}: give a height above 0, below {highest:g} m",
            height=height_m,
            highest=HIGHEST_GUIDE_M,
        )


def list_usual_quantities(engine: Engine) -> tuple[str, ...]:
    """Return the quantities that are computed by default. For an engine with gas, they include all
    quantities of gas.
    """
    return UNASKED if engine.gas is None else (*UNASKED, *GAS_KINDS)


def _choose_quantities(engine: Engine, only: str | Collection[str] | None) -> set[str]:
    """Return the quantities to compute; `gas` stands for all quantities of gas."""
    if only is None:
        return set(list_usual_quantities(engine))
    wanted = {*list_words("only", only)}
    if strangers := sorted(wanted.difference(QUANTITIES, GAS_KINDS, EXTRAS)):
        named = ", ".join(stranger or '""' for stranger in strangers)
        choices = ", ".join((*QUANTITIES, GAS.name, *EXTRAS))
        raise BalcliError(f"there is no quantity {named}: choose from {choices}")
    if GAS.name in wanted:
        wanted |= GAS_KINDS.keys()
    return wanted


def list_idle_defaults(engine: Engine, wanted: Collection[str]) -> set[str]:
    """Return the keys (and "gas" for the table [gas]) whose defaults affect none of the wanted
    quantities.

    Args:
        engine: One engine, not an array of variants.
        wanted: Quantities to compute.
    """
    due = {*wanted}
    if engine.gas is not None and due.intersection(EXTRAS) - {"masses"}:
        due.add("gas")
    of_throws = {*_WITH_THROWS, "masses", "parts"}
    if engine.ripple:
        of_throws |= list_with("turning")
    if any(engine.reference_m[:2]):
        of_throws |= list_with("arms")
    idle = set()
    for key, quantities in {**_DEPENDENT, "crank.throw_mass": of_throws}.items():
        if due.isdisjoint(quantities):
            idle.add(key)
    throws_inferred = any(value.path == "crank.throws" for value in engine.inferred)
    if engine.gas is not None and "gas" in idle and not throws_inferred:
        idle |= _OF_FIRING
    if not engine.places_known:
        idle.add("layout.stagger")
    return idle


def _analyze_cylinders(
    engine: Engine, orders: Array, kinds: Collection[str]
) -> tuple[CylinderShare, ...]:
    count = len(orders) * len(engine.numbers)
    most = MOST_RESULTS_BY_CYLINDER // len(engine.numbers)
    if count > MOST_RESULTS_BY_CYLINDER:
        raise BalcliError(f"by cylinder: {count} results; give at most {most} orders")
    own = compute_spectra(engine, orders, kinds, by_cylinder=True)
    shares = []
    for number in engine.rising_numbers:
        shares.append(CylinderShare(number, own.select_place(engine.numbers.index(number))))
    return tuple(shares)


def _analyze_banks(engine: Engine, orders: Array, kinds: Collection[str]) -> tuple[BankShare, ...]:
    own = _analyze_cylinders(engine, orders, kinds)
    c = engine.cylinders
    ends = [*c.starts[1:].tolist(), c.count]
    shares = []
    for axis_deg, start, end in zip(c.axis_deg.tolist(), c.starts.tolist(), ends, strict=True):
        here = engine.numbers[start:end]
        numbers = [number for number in engine.rising_numbers if number in here]
        members = [share.spectra for share in own if share.cylinder in numbers]
        sums = {}
        for name in members[0].kinds:
            sums[name] = reduce(add, [spectra.kinds[name] for spectra in members]).drop_noise()
        shares.append(BankShare(axis_deg, tuple(numbers), replace(members[0], kinds=sums)))
    return tuple(shares)


def _judge(engine: Engine, spectra: Spectra, small: float) -> Verdict:
    """Return the verdict; if the positions of the throws are not known, only on forces."""
    if not engine.places_known:
        spectra = spectra.only({*spectra.kinds} - {"moment"})
    return judge(spectra, find_scales(engine), small=small, engine=engine)


def _size(engine: Engine, ladder: Ladder, asked: Array | None, wanted: Collection[str]) -> Sizing:
    """Return the devices of the ladder's default step, and the engine's analysis with them."""
    remedy = ladder.fit()
    left = {*wanted, "force", "moment", "peak"} - {"sizing", "ladder"}
    return Sizing(remedy, analyze(fit_devices(engine, remedy), asked, left))


def list_strokes(engine: Engine) -> tuple[Stroke, ...]:
    """Return strokes and dead centres, sorted by cylinder number."""
    columns = ((values + 0.0).tolist() for values in find_travel(engine.cylinders))
    return tuple(sorted(map(Stroke, engine.numbers, *columns)))


def _find_stars(
    engine: Engine, orders: Iterable[float], kinds: Collection[str]
) -> tuple[Star, ...] | None:
    """Return the phasor stars of the force and, if moments are known and wanted, of the moment;
    None if the force is not wanted.
    """
    if "force" not in kinds:
        return None
    shown = {"force"}
    if engine.places_known and "moment" in kinds:
        shown.add("moment")
    return tuple(find_stars(engine, orders, shown))


def find_inner_loads(engine: Engine, asked: Array | None = None) -> InnerLoads:
    """Return shear, bending and bearing loads along the crankshaft. For an engine with gas, loads
    with gas are included if they can be computed.

    Args:
        engine: One engine, not an array of variants.
        asked: Orders to show, shape (orders,); None: the default orders.
    """
    inner = compute_inner_loads(engine, asked)
    if engine.gas is None:
        return inner
    from ..forces.loads_with_gas import add_gas_loads  # loads the curves of the gas

    return add_gas_loads(inner, engine, asked)
