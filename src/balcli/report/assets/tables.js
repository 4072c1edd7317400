"use strict";
// Tables of a document (`balcli.analysis/1`) with the columns, units and digits of the command's sheet.
// A table is { head, rows, words }: texts, and the numbers of the columns that are words.
const Tables = (() => {
  const BALANCED = "balanced";
  const UNKNOWN = "–";
  const SMALLEST = "<0.1 %";
  const TINY = 1e-12;                                         // a smaller share of one cylinder's value is rounding
  const MOST_AXES = 9;                                        // listed axes of banks
  const MOST_THROWS = 12;                                     // listed angles of throws
  const PER_RADIAN = 180 / Math.PI;                           // degrees
  const { units, limits } = JSON.parse(document.getElementById("page").textContent);
  const UNIT_OF = { force: units.force, moment: units.moment };
  const KEYS = { force: "force_N", moment: "moment_Nm" };
  const size = ([x, y]) => Math.hypot(x, y);

  // ------------------------------------------------------------------ figures
  // A figure without exponent between 0.0001 and a million, as the command writes it.
  function number(value, digits = 4) {
    if (value === null || value === undefined || Number.isNaN(value)) return UNKNOWN;
    const exact = dropRounding(value, digits);
    const rounded = roundTo(exact, digits);
    if (!rounded) return "0";
    const mostWhole = 10 ** Math.max(digits + 2, 6);          // whole numbers are written out up to here
    if (Math.abs(rounded) >= 10 ** digits && Math.abs(exact) < mostWhole) return roundHalfEven(exact);
    if (Math.abs(rounded) < 1e-4 || Math.abs(rounded) >= 10 ** digits) return rounded.toExponential().replace("+", "");
    return String(rounded);
  }
  const dropRounding = (value, digits) => Number(value.toPrecision(Math.max(digits, 12)));

  // Rounded to significant digits; of two equally near figures, the one with an even last digit, as in Python.
  function roundTo(exact, digits) {
    const nearest = Number(exact.toPrecision(digits));
    const firstDigit = Math.floor(Math.log10(Math.abs(exact) || 1));
    const last = 10 ** (firstDigit + 1 - digits);             // value of 1 in the last digit
    const away = Math.abs(nearest - exact) / last;
    const isTie = Number.isInteger(exact * 4096) && Math.abs(away - 0.5) < 1e-6;
    const isOdd = Math.round(Math.abs(nearest) / last) % 2;
    if (!isTie || !isOdd) return nearest;
    return Number((nearest - Math.sign(nearest) * last).toPrecision(digits));
  }
  function roundHalfEven(value) {
    const below = Math.floor(value);
    if (value - below !== 0.5) return String(Math.round(value));
    return String(below + Math.abs(below % 2));
  }
  function degrees(value, turn = 360) {
    if (value === null || Number.isNaN(value)) return UNKNOWN;
    const withoutRounding = Math.round(value * 1e6) / 1e6;
    const tenths = Number(withoutRounding.toFixed(1)) + 0;    // no -0
    if (tenths === -turn / 2) return (turn / 2).toFixed(1);
    return tenths === 360 ? "0.0" : tenths.toFixed(1);
  }
  function orderName(order) {
    if (order % 1 === 0) return String(order);
    return `${Math.floor(order) || ""}½`;
  }

  // The unit that fits a largest value: this one, or a larger one.
  function fit(unit, largest) {
    const outgrown = unit.larger && Math.abs(largest) >= unit.most * unit.size;
    return outgrown ? fit(unit.larger, largest) : unit;
  }
  function sizeText(value, unit, digits = 4) {
    const fitting = fit(unit, value);
    return `${number(value / fitting.size, digits)} ${fitting.name}`;
  }
  const smallText = (value, unit) => value ? `negligible (${sizeText(value, unit, 2)})` : BALANCED;

  // ------------------------------------------------------------------ force and moment of a document
  const known = ({ ladder }) => ladder.scale.moment_Nm !== undefined;
  const kindsOf = (figures) => known(figures) ? ["force", "moment"] : ["force"];
  const scaleOf = ({ ladder }, kind) => ladder.scale[KEYS[kind]];
  const isNegligible = (figures, kind, value) => value < limits.negligible * scaleOf(figures, kind);

  // ------------------------------------------------------------------ orders
  // The orders up to 2, and those with a force or moment that is not negligible beside one cylinder's.
  function listOrders(figures) {
    const kinds = kindsOf(figures);
    const matters = (entry) => kinds.some((kind) => entry[KEYS[kind]].major > limits.negligible * scaleOf(figures, kind));
    return figures.orders.filter((entry) => [0, 1, 2].includes(entry.order) || matters(entry));
  }
  function makeOrders(figures) {
    const shown = listOrders(figures);
    const head = ["order"];
    const rows = shown.map(({ order }) => [orderName(order)]);
    for (const kind of kindsOf(figures)) {
      const vectors = shown.map((entry) => entry[KEYS[kind]]);
      const unit = fit(UNIT_OF[kind], Math.max(...vectors.map(({ major }) => major)));
      head.push(`${kind}, ${unit.name}`, "with crank", "against");
      vectors.forEach((vector, k) => rows[k].push(...writeVector(vector, shown[k].order, unit)));
    }
    return { head, rows, words: [0] };
  }
  function writeVector(vector, order, unit) {
    if (vector.balanced) return [BALANCED, "", ""];
    const write = (value) => number(value / unit.size);
    if (!order) return [write(vector.major), UNKNOWN, UNKNOWN];
    return [write(vector.major), write(size(vector.forward)), write(size(vector.backward))];
  }

  // What cancels an order, in a few words; none for a small one.
  function tellCures({ verdict, page }, order) {
    const finding = verdict.matter.find((other) => other.order === order);
    if (!finding) return "";
    if (order > 2) return "usually left";
    if (!finding.cures && !page.crossheads) return "no device is named";  // uneven speed, half orders, shafts of locomotives
    if (!finding.cures) return order > 1 ? "compensators" : "counterweights, compensators";
    const takingBack = finding.cures.filter((cure) => cure.takes_back);
    const named = takingBack.length ? takingBack : finding.cures;
    return named.map(nameCure).join(", ") || "no part is worth a shaft";
  }
  function nameCure({ ratio, on_crank, further, takes_back }) {
    if (takes_back) return "counterweights would take back those of the file";
    const device = on_crank ? "counterweights" : `shaft at ${writeRatio(ratio)}`;
    return further ? `further ${device}` : device;
  }
  const writeRatio = (ratio) => ratio > 0 ? `+${ratio}` : String(ratio);
  function addCures(figures, { head, rows, words }) {
    const cures = listOrders(figures).map(({ order }) => tellCures(figures, order));
    return {
      head: [...head, "cancelled by"],
      words: [...words, head.length],
      rows: rows.map((row, k) => [...row, cures[k]]),
    };
  }

  // ------------------------------------------------------------------ about the crank, and largest values
  // The couple by order, where it is not negligible; no rows if it is nowhere.
  function makeAbout(figures) {
    const least = limits.worthNaming * figures.page.scales.roll_Nm * (1 - 1e-9);
    const shown = figures.orders.filter(({ order, couple_Nm: { amplitude } }) => order > 0 && amplitude && amplitude >= least);
    const amplitudes = shown.map(({ couple_Nm }) => couple_Nm.amplitude);
    const unit = fit(units.moment, Math.max(0, ...amplitudes));
    const rows = shown.map(({ order, couple_Nm: { amplitude, peak_deg } }) =>
      [orderName(order), number(amplitude / unit.size), degrees(peak_deg)]);
    return { head: ["order", "couple C", "peak, deg"], rows, words: [0], unit: unit.name };
  }

  // Roll by order, and the largest force and moment over a revolution, as pairs of name and text.
  function listLargest(figures, gas) {
    const pairs = [[gas ? "roll moment, inertia alone" : "roll moment", tellRoll(figures)]];
    for (const kind of kindsOf(figures)) pairs.push([kind, tellPeak(figures, kind)]);
    if (!known(figures)) pairs.push(["moment", UNKNOWN]);
    return pairs;
  }
  function tellRoll(figures) {
    const least = limits.negligible * figures.page.scales.roll_Nm;
    const largest = Math.max(0, ...figures.orders.map(({ roll_Nm }) => roll_Nm.amplitude));
    const shown = figures.orders.filter(({ roll_Nm }) => roll_Nm.amplitude > least);
    if (!shown.length) return smallText(largest, units.moment);
    const unit = fit(units.moment, largest);
    const texts = shown.map(({ order, roll_Nm }) => `${orderName(order)}: ${number(roll_Nm.amplitude / unit.size)}`);
    const { value_Nm, deg } = figures.page.roll;
    return `${sizeText(value_Nm, units.moment, 5)} at crank angle ${degrees(deg)} deg; order ${texts.join(", ")} ${unit.name}`;
  }
  function tellPeak(figures, kind) {
    const value = figures.peak[KEYS[kind]];
    if (!value || isNegligible(figures, kind, value)) return smallText(value, UNIT_OF[kind]);
    const largest = sizeText(value, UNIT_OF[kind], 5);
    const every = figures.page.every[kind];
    if (!every) return `${largest} at every crank angle`;
    const again = every < 360 - 1e-6 ? ` and every ${Number(every.toPrecision(6))} deg` : "";
    return `${largest} at crank angle ${degrees(figures.peak[`${kind}_deg`])} deg${again}`;
  }

  // ------------------------------------------------------------------ ladder and devices
  function makeLadder(figures) {
    const { steps } = figures.ladder;
    const head = ["step"];
    const rows = steps.map(({ step }, k) => [`${k} ${step}`]);
    const addColumn = (title, cells) => {
      head.push(title);
      cells.forEach((cell, k) => rows[k].push(cell));
    };
    const addSizes = (title, kind, values) => {
      const unit = fit(UNIT_OF[kind], Math.max(...values));
      addColumn(`${title}, ${unit.name}`, values.map((value) => writeSize(figures, kind, value, unit)));
    };
    for (const kind of kindsOf(figures)) addSizes(kind, kind, steps.map((step) => step[`peak_${KEYS[kind]}`]));
    if (steps[0].main_bearing_N !== undefined) addSizes("main bearing", "force", steps.map((step) => step.main_bearing_N));
    addColumn("weights", steps.map((step) => String(step.counterweights || UNKNOWN)));
    addColumn("shafts", steps.map((step) => String(step.shafts || UNKNOWN)));
    addColumn(`steel, ${units.mass.name}`, steps.map(({ steel_kg }) => steel_kg ? number(steel_kg / units.mass.size, 3) : UNKNOWN));
    return { head, rows, words: [0] };
  }
  function writeSize(figures, kind, value, unit) {
    if (value <= TINY * scaleOf(figures, kind)) return BALANCED;
    return isNegligible(figures, kind, value) ? SMALLEST : number(value / unit.size);
  }
  function makeDevices({ devices }) {
    const unit = fit(units.unbalance, Math.max(0, ...devices.map((device) => device.unbalance_kg_m)));
    const length = units.length.name;
    return {
      head: ["device", "speed ratio", unit.name, "angle, deg", `x, y, ${length}`, `z, ${length}`],
      rows: devices.map((device) => writeDevice(device, unit)),
      words: [0, 3, 4],
    };
  }
  function writeDevice({ device, crank, ratio, unbalance_kg_m, angle_deg, free, at_mm, position_mm }, unit) {
    const unbalance = number(unbalance_kg_m / unit.size);
    const angle = degrees(angle_deg);
    const position = writeLength(position_mm / 1e3);
    if (device === "counterweight") {
      const axis = crank ? `crank of ${crank}` : "crank axis";
      return [device, "1", unbalance, `${angle} from pin 1`, axis, position];
    }
    const place = free ? "free" : at_mm.map((mm) => writeLength(mm / 1e3)).join(", ");
    return [device, writeRatio(ratio), unbalance, angle, place, position];
  }
  const writeLength = (metres, digits) => number(metres / units.length.size, digits);

  // ------------------------------------------------------------------ facts of an engine of the kernel
  // Names and texts of the head, but for those that need Python's words (firing, numbering, assumed values).
  function listFacts(engine, data) {
    const { cylinders, devices } = engine;
    const first = cylinders.find((cylinder) => cylinder.number === 1);
    const others = areEqual(cylinders) ? "" : " (cylinder 1; others differ)";
    const facts = [
      ["cylinders", `${cylinders.length}${tellBanks(cylinders)}${tellBore(engine, data, first)}`],
      ["crank", tellCrank(first) + others],
      ["throws", tellThrows(cylinders, first)],
      ["speed", `${number(data.speed, 6)} rpm`],
      ["masses", tellMasses(engine, first) + others],
      ["devices", devices.length ? `${devices.length} from the file included` : ""],
    ];
    return facts.filter(([, text]) => text);
  }
  const areEqual = ([first, ...others]) =>
    others.every((other) => ["r", "l", "e", "reciprocating"].every((key) => other[key] === first[key]));
  function tellCrank({ r, l }) {
    const mm = units.length.name;
    const lambda = number(r / l, r / l < 0.999 ? 4 : 7);
    return `r = ${writeLength(r)} ${mm}, rod ${writeLength(l)} ${mm}, λ = ${lambda}`;
  }
  function tellBanks(cylinders) {
    const axisOfBank = new Map(cylinders.map(({ bank, axis }) => [bank, axis]));
    const axes = [...axisOfBank.values()].map((axis) => number(axis * PER_RADIAN + 0));
    if (axes.length === 1) return " in line";
    const more = axes.length > MOST_AXES ? " …" : "";
    return `, banks at ${axes.slice(0, MOST_AXES).join(", ")}${more} deg`;
  }
  function tellBore({ bore, cylinders, r }, { fires }, first) {
    if (!bore) return "";
    const burning = cylinders.filter((cylinder) => !fires || fires.includes(cylinder.number));
    const travels = burning.reduce((total, cylinder) => total + findTravel(cylinder), 0);
    const volume = Math.PI / 4 * bore ** 2 * travels;
    const mm = units.length.name;
    const travel = writeLength(findTravel(first));
    const differs = travel === writeLength(2 * first.r) ? "" : ` (true stroke ${travel} ${mm})`;
    const unit = fit(units.volume, volume);
    return `, bore × stroke ${writeLength(bore, 5)} × ${writeLength(2 * r, 5)} ${mm}${differs}, ${number(volume / unit.size)} ${unit.name}`;
  }
  // Travel of a piston: between the two places at which crank and rod point the same way.
  const findTravel = ({ r, l, e }) => Math.sqrt((l + r) ** 2 - e ** 2) - Math.sqrt((l - r) ** 2 - e ** 2);

  // Angles of the throws from the pin of cylinder 1, and the splay of split pins.
  function tellThrows(cylinders, first) {
    const pinsOfThrow = new Map();                            // deg, by throw
    for (const { throw: own, axis, psi } of cylinders) {
      const pin = (axis + psi - first.axis - first.psi) * PER_RADIAN;
      pinsOfThrow.set(own, [...(pinsOfThrow.get(own) || []), pin]);
    }
    const throws = [...pinsOfThrow].sort(([a], [b]) => a - b).map(([, pins]) => pins);
    const [pin, next] = throws[0];
    const lead = next === undefined ? 0 : round(wrap(next - pin, -180), 6);
    if (throws.length === 1 && !lead) return "";
    const angles = throws.map(([angle]) => number(wrap(round(round(angle, 6), 1), 0), 6));
    const more = angles.length > MOST_THROWS ? ", …" : "";
    const begin = angles[0] === "0" ? "" : " from cylinder 1's pin";
    const splay = lead ? `, split pins: the next bank's pin at ${lead > 0 ? "+" : ""}${number(lead, 6)} deg` : "";
    return `${angles.slice(0, MOST_THROWS).join(", ")}${more} deg${begin}${splay}`;
  }
  const round = (value, decimals) => Number(value.toFixed(decimals));
  const wrap = (angle, from) => ((angle - from) % 360 + 360) % 360 + from;   // to a revolution that begins at `from`

  function tellMasses({ cylinders, throws }, first) {
    const write = (kg) => number(kg / units.mass.size);
    const findThrow = (cylinder) => throws.findIndex(({ files }) => files.includes(cylinder.throw));
    const namePin = (cylinder) => [findThrow(cylinder), Math.round((cylinder.axis + cylinder.psi) * 1e8), cylinder.r].join(" ");
    const sharing = cylinders.filter((cylinder) => namePin(cylinder) === namePin(first));
    const onPin = sharing.reduce((total, cylinder) => total + cylinder.rotating, 0);
    const perPin = sharing.length > 1 ? ` (${write(onPin)} per pin of ${sharing.length} rods)` : "";
    const kg = units.mass.name;
    return `reciprocating ${write(first.reciprocating)} ${kg} per cylinder, rotating ${write(first.rotating)} ${kg} per rod${perPin}`;
  }

  // ------------------------------------------------------------------ markup
  function make(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    Object.assign(made, attributes);
    made.append(...children);
    return made;
  }

  // Fills a table of the page, in the markup of the template.
  function fill(table, { head, rows, words }) {
    const attributesOf = (column) => words.includes(column) ? { className: "words" } : {};
    const makeCell = (text, column) => {
      const content = text === BALANCED ? make("b", { className: "ok" }, text) : text;
      if (column) return make("td", attributesOf(column), content);
      return make("th", { scope: "row", ...attributesOf(column) }, content);
    };
    const heads = head.map((text, column) => make("th", { scope: "col", ...attributesOf(column) }, text));
    const lines = rows.map((row) => make("tr", {}, ...row.map(makeCell)));
    table.replaceChildren(make("thead", {}, make("tr", {}, ...heads)), make("tbody", {}, ...lines));
  }
  function fillFacts(list, pairs) {
    const entries = pairs.map(([name, text, className = ""]) => make("div", { className }, make("dt", {}, name), make("dd", {}, text)));
    list.replaceChildren(...entries);
  }

  return {
    BALANCED, KEYS, UNIT_OF, units, limits,
    number, degrees, orderName, fit, sizeText, smallText,
    known, kindsOf, scaleOf, isNegligible, listOrders, tellCures, nameCure,
    makeOrders, addCures, makeAbout, listLargest, makeLadder, makeDevices, listFacts,
    make, fill, fillFacts,
  };
})();
