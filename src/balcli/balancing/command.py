"""The command `balance`: its options, among them the workshop's tools and balance grades, and its
output.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import isinf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from ..core.unbalance import SLUGS
from ..errors import BalcliError, name_option, naming_file, note, warn
from ..file.edit import set_speed
from ..file.fields import join_words
from ..file.toml import name_file
from ..file.units import ANGLE, MASS
from ..shell import scheme_options
from ..shell.file_names import TEXTS, format_of, format_option, require_ending
from ..shell.inputs import read_engine, warn_each
from ..shell.options import (
    EnginePath,
    Orders,
    Output,
    Small,
    Speed,
    UnitsOption,
    parse_orders,
    parse_speed,
)
from ..shell.output import emit, refuse_leaving_files, refuse_overwriting, show, write_file
from ..shell.scheme_options import choose_scheme, complete_schemes, parse_scheme_options
from ..shell.values import (
    optional,
    read_figure,
    read_length,
    read_lengths,
    read_number,
    read_share,
)
from ..show.formats import Format, Units
from ..sizing.options import ALL, FIT, KNUCKLES, MEANINGS, OPTIONS, SchemeOptions

if TYPE_CHECKING:
    from ..engine.engine import Engine
    from ..file.model import EngineFile
    from ..sizing.workshop import Misfit, Shapes, Tools
    from .answer import Balance


FormatOption = Annotated[
    Format | None,
    format_option(
        (*TEXTS.values(), Format.CARD),
        "Default: by the ending of -o, else table. card: a sheet for the workshop.",
    ),
]
Scheme = Annotated[
    str | None,
    optional(
        "NAME",
        "Scheme to fit (--schemes lists them); default: auto; factor with --factor, and for webs "
        'that are "fit".',
        "--scheme",
        "--with",
        autocompletion=complete_schemes,
    ),
]
Step = Annotated[
    str | None, optional("STEP", "Fit this row of the ladder (name or number), or only steps 2+4.")
]


def _list_schemes(wanted: bool) -> None:
    """Print the meaning and the options of each scheme, and end the program."""
    if not wanted:
        return
    width = max(map(len, MEANINGS))
    lines = []
    for name, meaning in MEANINGS.items():
        options = " ".join(f"--{option}" for option in OPTIONS[name])
        lines.append(f"{name:{width}}  {meaning}")
        lines += [f"{'':{width}}    {options}"] if options else []
    emit("\n".join(lines))
    raise typer.Exit


Schemes = Annotated[
    bool,
    typer.Option(
        "--schemes",
        callback=_list_schemes,
        is_eager=True,
        help="List all schemes with their options.",
    ),
]
Radius = Annotated[str | None, optional("MM", "Radius of the weights; default: crank radius.")]
Thickness = Annotated[
    str | None, optional("MM", "Thickness of half-disc weights; their radius follows.")
]
Disc = Annotated[
    str | None, optional("MM", "Radius of half-disc weights; default: that of the room.")
]
Drill = Annotated[str | None, optional("MM", "Diameter of holes to drill from --radius inwards.")]
MaxDepth = Annotated[str | None, optional("MM", "Deepest hole; default: to the axis.")]
Slug = Annotated[str | None, optional("METAL", "Slugs in holes: tungsten, lead, or g/cm3.")]
Width = Annotated[
    str | None,
    optional("MM", "Room for holes along z; default: distance of the throws."),
]
Bearings = Annotated[str | None, optional("Z1,Z2", "Bearings of the new shafts, along z in mm.")]
SectorOption = Annotated[
    str | None,
    optional("INNER,OUTER,OPENING", "New counterweights as sectors: mm, mm, deg.", "--sector"),
]
Target = Annotated[
    str | None,
    optional(
        "NAME,...",
        'Quantities that devices with unbalance = "fit" are to cancel: force, moment, roll, '
        "roll_total; default: force,moment.",
    ),
]
Direction = Annotated[str | None, optional("DEG", "ellipse: direction of the remaining force.")]
Ratio = Annotated[str | None, optional("SHARE", "ellipse: smallest over largest force left.")]
Design = Annotated[str | None, optional("a|b", "Design of --scheme eccentric-slider; default: a.")]
Criterion = Annotated[str | None, optional("largest|mean", "Force to minimise; default: largest.")]
Even = Annotated[str | None, optional("dead-centres|strokes", "knuckles: what to make equal.")]
Grade = Annotated[str | None, optional("G", "Balance grade of ISO 21940-11, such as G16.")]
Mass = Annotated[str | None, optional("KG", "Mass of the crankshaft, for --grade.")]
Write = Annotated[
    Path | None, optional("OUT.toml", "Write the engine with the new devices or webs.")
]


def show_balance(result: Balance, form: Format, output: Path | None, units: Units) -> None:
    """Print or write a balance, or its bobweight card (format card)."""
    for reason in dict.fromkeys(result.remedy.every_reason):
        note(f"scheme {result.remedy.scheme}: {reason}")
    from . import show as renderer

    rendering = renderer.RENDERER
    if form is Format.CARD:
        rendering = replace(rendering, sheet=renderer.card_sheet)
    show([result], rendering, form, output, units)


def parse_tools(units: Units, slug: str | None, **lengths: str | None) -> Tools:
    """Return the tools of the workshop.

    Args:
        units: Units of the command.
        slug: Name of a metal, or a density in g/cm3.
        lengths: Texts of the options that are lengths, by the names of these options in `Tools`.

    Raises:
        BalcliError: A text is not a length, or not a metal.
    """
    from ..sizing.workshop import Tools

    figures = {}
    for name, text in lengths.items():
        if text is not None:
            figures[name] = read_length(name, text, units)
    if slug is not None:
        wanted = f"{', '.join(SLUGS)}, or a density in g/cm3 such as 18.5"
        density = SLUGS.get(slug.strip().lower())
        figures["slug"] = density or 1e3 * read_number("slug", slug, wanted)
    return Tools(**figures)


def parse_shapes(
    units: Units, bearings: str | None, sector: str | None
) -> tuple[tuple[float, ...] | None, tuple[float, ...] | None]:
    """Return bearings and sector of new devices, read from the texts of options; None: not given.

    Args:
        units: Units of the command.
        bearings: Places of two bearings.
        sector: Inner radius, outer radius and opening.

    Raises:
        BalcliError: A text cannot be read.
    """
    wanted = "the places of two bearings along z in mm, such as -130,130"
    places = None if bearings is None else read_lengths("bearings", bearings, wanted, 2, units)
    if sector is None:
        return places, None
    wanted = "inner and outer radius in mm and opening in deg, such as 30,75,140"
    radii, _, opening = sector.rpartition(",")
    lengths = read_lengths("sector", radii, wanted, 2, units)
    return places, (*lengths, read_figure("sector", opening, ANGLE))


def _warn_of_discs(name: str, tools: Tools, misfits: Sequence[Misfit]) -> None:
    """Warn of half discs that were asked for and exceed the room around the crank."""
    asked = [misfit for misfit in misfits if misfit.asked]
    largest = max(asked, key=lambda misfit: misfit.thickness, default=None)
    if largest is None or largest.disc is None:
        return
    disc = largest.disc
    room = largest.room
    option = "--thickness" if tools.disc is None else "--disc"
    numbers = join_words([str(misfit.number) for misfit in asked])
    limit = "" if isinf(room.thickness_m) else f", thickness {1e3 * room.thickness_m:.4g} mm"
    warn(
        f"{name}: {option}: half discs beyond the room around the crank (radius "
        f"{1e3 * (room.radius_m or 0):.4g} mm{limit}) for weights {numbers}: radius "
        f"{1e3 * disc.radius:.4g} mm, thickness {1e3 * disc.thickness:.4g} mm"
    )


def _warn_of_mass(name: str, result: Balance) -> None:
    """Warn of a mass of the crankshaft that is less than that of its webs and crank pins."""
    engine = (result.after if result.remedy.webs else result.before).engine
    if not hasattr(result, "permitted") or engine.webs is None:
        return
    mass = result.permitted.mass_kg
    least = engine.webs.mass
    if mass < least:
        warn(
            f"{name}: --mass: {mass:g} kg is less than the {least:.4g} kg of webs and crank pins; "
            "give the mass of the whole crankshaft as it is balanced, with bobweights"
        )


def parse_grade(text: str | None) -> float | None:
    """Return the grade of `--grade` (`16` or `G16`), mm/s."""
    if text is None:
        return None
    wanted = "a grade of ISO 21940-11 such as G16 or 6.3"
    return read_number("grade", text.strip().removeprefix("G"), wanted)


class _Question(NamedTuple):
    """What a call asks.

    Attributes:
        name: Name of the file.
        engine: Its engine, without what is "fit".
        model: The file.
        scheme: Scheme to fit.
        options: Options of the scheme.
        orders: Orders to show; None: those that are not negligible.
        shapes: Shapes of new devices.
        targets: Quantities that devices with "fit" are to cancel; None: not given.
        even: What scheme knuckles makes equal; None: not given.
        open_devices: Devices whose unbalance is "fit".
        open_webs: Dimensions of webs that are "fit".
    """

    name: str
    engine: Engine
    model: EngineFile
    scheme: str
    options: SchemeOptions
    orders: Sequence[float] | None
    shapes: Shapes
    targets: list[str] | None
    even: str | None
    open_devices: list[str]
    open_webs: list[str]

    @property
    def fits_devices(self) -> bool:
        """Whether devices with "fit" are fitted."""
        if self.open_webs:
            return self.targets is not None
        return bool(self.open_devices) or self.targets is not None or self.scheme == FIT

    def check(self) -> None:
        """Raise BalcliError if file, scheme and options do not go together."""
        if self.fits_devices:
            _check_fit(self.name, self.scheme, self.options, self.open_devices)
        _check_scheme(self.scheme, self.options, self.even, self.shapes)

    def answer(self, tools: Tools) -> Balance:
        """Return the balance; `tools`: tools of the workshop."""
        from . import answer

        if self.open_webs:
            with naming_file(self.name):
                return answer.balance_webs(
                    self.engine,
                    self.model,
                    self.scheme,
                    self.options,
                    self.orders,
                    tools,
                    self.shapes,
                )
        if self.fits_devices:
            return answer.balance_fit(
                self.engine,
                self.model,
                self.targets,
                self.orders,
                tools,
                self.options.read_small(),
            )
        if self.scheme == KNUCKLES:
            goal = self.even or "dead-centres"
            speed = float(self.engine.speed_rpm)
            return answer.balance_knuckles(self.model, goal, self.orders, speed)
        return answer.balance(
            self.engine, self.scheme, self.options, self.orders, tools, self.shapes
        )


def _check_fit(name: str, scheme: str, options: SchemeOptions, open_devices: Sequence[str]) -> None:
    """Reject schemes other than fit for a file with devices to fit, and the scheme fit for other
    files.

    Args:
        name: Name of the file.
        scheme: Wanted scheme.
        options: Options of the scheme.
        open_devices: Names of the devices whose unbalance is "fit".

    Raises:
        BalcliError: Scheme and file do not go together.
    """
    if not open_devices:
        raise BalcliError(
            f'{name}: no device has unbalance = "fit", so --scheme fit and --target have nothing '
            "to fit; write this key into a [[counterweight]], [[shaft]] or [[slider]]"
        )
    if scheme != FIT or options != SchemeOptions(small=options.small):
        raise BalcliError(
            f'{name}: {open_devices[0]}.unbalance is "fit", so balance fits only such devices; '
            f"leave out scheme {scheme} and its options (--target is allowed)"
        )


def _check_scheme(scheme: str, options: SchemeOptions, even: str | None, shapes: Shapes) -> None:
    """Raise BalcliError for --even with another scheme, for options that knuckles does not take,
    and for shapes if the scheme adds no devices.
    """
    if even is not None and scheme != KNUCKLES:
        raise BalcliError(
            f"--even belongs to --scheme knuckles; scheme {scheme} has no such option"
        )
    if scheme == KNUCKLES and options != SchemeOptions():
        raise BalcliError("scheme knuckles takes no option but --even")
    if any(shapes) and scheme in (FIT, KNUCKLES):
        raise BalcliError(f"--bearings and --sector are for new devices; scheme {scheme} adds none")


def _read_mass(text: str | None, units: Units) -> float | None:
    """Return the mass of `--mass`, kg; None: not given."""
    return None if text is None else read_figure("mass", text, MASS, units)


def _write_balanced(
    text: bytes, path: str, write: Path, result: Balance, rpm: float | None
) -> None:
    """Write the engine file with the new devices, and with the speed that the command was given."""
    from .answer import insert_remedy

    refuse_leaving_files(text, path, write)
    new = insert_remedy(text, result.remedy, name_file(path))
    if rpm is not None:
        new = set_speed(new, rpm, "as balanced by balcli")
    write_file(new, write)


def _show_all(engine: Engine, form: Format, output: Path | None, units: Units) -> None:
    """Show what every scheme leaves."""
    from .all_schemes import RENDERER, compare_schemes

    if form is Format.CARD:
        raise BalcliError("--format card is for one scheme, and scheme all compares them")
    show([compare_schemes(engine)], RENDERER, form, output, units)


def _refuse_beside_all(options: SchemeOptions, tools: Tools, **others: object) -> None:
    """Raise BalcliError if anything that belongs to one scheme is given with scheme all."""
    given = [name for name, value in others.items() if value is not None]
    given += [name for name, value in options._asdict().items() if value is not None]
    given += [name for name, value in tools._asdict().items() if value is not None]
    if given:
        raise BalcliError(
            f"scheme all shows every scheme with its default options; leave "
            f"{', '.join(map(name_option, given))} out, or name one scheme"
        )


def balance(
    path: EnginePath,
    scheme: Scheme = None,
    _schemes: Schemes = False,
    order: scheme_options.Order = None,
    at: scheme_options.At = None,
    position: scheme_options.Position = None,
    planes: scheme_options.Planes = None,
    factor: scheme_options.Factor = None,
    measured: scheme_options.Measured = None,
    roll: scheme_options.Roll = None,
    step: Step = None,
    small: Small = None,
    target: Target = None,
    direction: Direction = None,
    ratio: Ratio = None,
    design: Design = None,
    criterion: Criterion = None,
    radius: Radius = None,
    thickness: Thickness = None,
    disc: Disc = None,
    drill: Drill = None,
    max_depth: MaxDepth = None,
    slug: Slug = None,
    width: Width = None,
    bearings: Bearings = None,
    sector: SectorOption = None,
    even: Even = None,
    grade: Grade = None,
    mass: Mass = None,
    write: Write = None,
    speed: Speed = None,
    orders: Orders = None,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Size counterweights, balancer shafts or sliders, and show the forces that remain.

    \b
    Examples:
      balcli balance i4.toml --scheme two-shaft --at=-60,80
      balcli balance v8.toml --factor 51% --planes=-8.5in,9in --format card
      balcli balance v8.toml --factor 50%:54%:1% --planes ends
      balcli balance v8.toml --factor 51% --planes ends --drill 19 --max-depth 32
      balcli balance twin.toml --measured "812 g"
      balcli balance single.toml --scheme all
    """
    refuse_overwriting(reads=[path], writes={"--output": output, "--write": write})
    endings = {**TEXTS, ".txt": Format.CARD} if form is Format.CARD else TEXTS
    form = format_of(output, form, endings, Format.TABLE)
    require_ending(write, ".toml", "--write")
    from ..sizing.fit import list_open_webs, list_to_fit, remove_to_fit
    from ..sizing.workshop import HolesDoNotFitError, Shapes
    from . import answer

    options = parse_scheme_options(
        order, at, position, planes, factor, measured, roll, units, small
    )
    options = options._replace(
        step=step,
        direction=None if direction is None else read_figure("direction", direction, ANGLE),
        ratio=None if ratio is None else read_share("ratio", ratio, "a share such as 50%"),
        design=design,
        criterion=criterion,
    )
    lengths = {"radius": radius, "thickness": thickness, "disc": disc, "drill": drill}
    tools = parse_tools(units, slug, **lengths, max_depth=max_depth, width=width)
    shapes = Shapes(*parse_shapes(units, bearings, sector))
    grade_mm_s = parse_grade(grade)
    mass_kg = _read_mass(mass, units)
    asked = parse_orders(orders)
    rpm = parse_speed(speed)
    text, model, engine = read_engine(path, rpm, prepare=remove_to_fit)
    open_devices = [name for name, _ in list_to_fit(model)]
    open_webs = list_open_webs(model)
    scheme = choose_scheme(scheme, options, _choose_usual(step, form, open_devices, open_webs))
    if scheme == ALL and not open_devices and not open_webs:
        _refuse_beside_all(
            options,
            tools,
            orders=orders,
            even=even,
            grade=grade,
            mass=mass,
            bearings=bearings,
            sector=sector,
            target=target,
            write=write,
        )
        _show_all(engine, form, output, units)
        return
    question = _Question(
        name=name_file(path),
        engine=engine,
        model=model,
        scheme=scheme,
        options=options,
        orders=asked,
        shapes=shapes,
        targets=None if target is None else [name.strip() for name in target.split(",")],
        even=even,
        open_devices=open_devices,
        open_webs=open_webs,
    )
    question.check()
    misfit = None
    try:
        result = question.answer(tools)
    except HolesDoNotFitError as error:
        misfit = error
        holes = ("drill", "max_depth", "slug", "width")
        result = question.answer(tools._replace(**dict.fromkeys(holes)))
    result = answer.judge_unbalance(result, options, tools, grade_mm_s, mass_kg)
    if hasattr(result, "parts"):
        warn_each(result.parts.doubts, name_file(path))
    _warn_of_discs(name_file(path), tools, result.misfits)
    _warn_of_mass(name_file(path), result)
    if write is not None and misfit is None and result.webs_fit:
        _write_balanced(text, path, write, result, rpm)
    show_balance(result, form, output, units)
    if misfit is not None:
        raise misfit
    _refuse_misfits(name_file(path), result)


def _refuse_misfits(name: str, result: Balance) -> None:
    """Raise BalcliError if webs have no room for their counterweights.

    Args:
        name: Name of the file.
        result: Balance.
    """
    if not result.webs_fit:
        from .web_show import tell_misfits

        raise BalcliError(f"{name}: {tell_misfits(result)}")


def _choose_usual(
    step: str | None, form: Format, open_devices: list[str], open_webs: list[str]
) -> str:
    """Return the scheme of a call that names none.

    Args:
        step: Step of the ladder that the call names; None: no step.
        form: Format of the output.
        open_devices: Devices of the file whose figures are to be fitted.
        open_webs: Dimensions of webs that are to be fitted.
    """
    if step is not None:
        return "step"
    if form is Format.CARD or open_webs:
        return "factor"
    return FIT if open_devices else "auto"
