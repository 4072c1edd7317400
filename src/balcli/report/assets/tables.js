"use strict";
// Tables of a document (`balcli.analysis/1`) with the columns, units and digits of the command's sheet.
// A table is { head, rows, words }: texts, and the numbers of the columns that are words.
const Tables = (() => {
  const BALANCED = "balanced", UNKNOWN = "–", SMALLEST = "<0.1 %";
  const TINY = 1e-12;                                         // a smaller share of one cylinder's value is rounding
  const { units, limits } = JSON.parse(document.getElementById("page").textContent);
  const size = ([x, y]) => Math.hypot(x, y);
  const clean = (value, digits = 12) => Number(value.toPrecision(Math.max(digits, 12)));   // without rounding errors

  // ------------------------------------------------------------------ figures
  // A figure without exponent between 0.0001 and a million, as the command writes it.
  function number(value, digits = 4) {
    if (value === null || value === undefined || Number.isNaN(value)) return UNKNOWN;
    const exact = clean(value, digits), rounded = roundTo(exact, digits), large = Math.abs(exact);
    if (!rounded) return "0";
    if (Math.abs(rounded) >= 10 ** digits && large < 10 ** Math.max(digits + 2, 6)) return roundHalfEven(exact);
    if (Math.abs(rounded) < 1e-4 || Math.abs(rounded) >= 10 ** digits) return rounded.toExponential().replace("+", "");
    return String(rounded);
  }
  // Rounded to significant digits; of two equally near figures, the one with an even last digit, as in Python.
  function roundTo(exact, digits) {
    const up = Number(exact.toPrecision(digits)), last = 10 ** (Math.floor(Math.log10(Math.abs(exact) || 1)) + 1 - digits);
    const tie = Number.isInteger(exact * 4096) && Math.abs(Math.abs(up - exact) / last - 0.5) < 1e-6;
    return tie && Math.round(Math.abs(up) / last) % 2 ? Number((up - Math.sign(up) * last).toPrecision(digits)) : up;
  }
  function roundHalfEven(value) {
    const below = Math.floor(value), half = value - below === 0.5;
    return String(half ? below + Math.abs(below % 2) : Math.round(value));
  }
  function degrees(value, turn = 360) {
    if (value === null || Number.isNaN(value)) return UNKNOWN;
    let tenths = Number((Math.round(value * 1e6) / 1e6).toFixed(1)) + 0;
    if (tenths === -turn / 2) tenths = turn / 2;
    return tenths === 360 ? "0.0" : tenths.toFixed(1);
  }
  const orderName = (order) => order % 1 ? `${Math.floor(order) || ""}½` : String(order);
  // The unit that fits a largest value: this one, or a larger one.
  function fit(unit, largest) {
    const outgrown = unit.larger && Math.abs(largest) >= unit.most * unit.size;
    return outgrown ? fit(unit.larger, largest) : unit;
  }
  function sizeText(value, unit, digits = 4) {
    const own = fit(unit, value);
    return `${number(value / own.size, digits)} ${own.name}`;
  }
  const smallText = (value, unit) => value ? `negligible (${sizeText(value, unit, 2)})` : BALANCED;
  const known = ({ ladder: { scale } }) => scale.moment_Nm !== undefined;
  const UNIT_OF = { force: units.force, moment: units.moment };
  const KEYS = { force: "force_N", moment: "moment_Nm" };
  const kindsOf = (figures) => known(figures) ? ["force", "moment"] : ["force"];
  const scaleOf = ({ ladder: { scale } }, kind) => scale[KEYS[kind]];

  // ------------------------------------------------------------------ orders
  // The orders up to 2, and those with a force or moment that is not negligible beside one cylinder's.
  function listOrders(figures) {
    const matters = (entry) => kindsOf(figures).some((kind) =>
      entry[KEYS[kind]].major > limits.negligible * scaleOf(figures, kind));
    return figures.orders.filter((entry) => [0, 1, 2].includes(entry.order) || matters(entry));
  }
  function writeVector(vector, order, unit) {
    if (vector.balanced) return [BALANCED, "", ""];
    const shown = [vector.major, size(vector.forward), size(vector.backward)].map((v) => number(v / unit.size));
    return order ? shown : [shown[0], UNKNOWN, UNKNOWN];
  }
  function makeOrders(figures) {
    const shown = listOrders(figures), head = ["order"], rows = shown.map(({ order }) => [orderName(order)]);
    for (const kind of kindsOf(figures)) {
      const vectors = shown.map((entry) => entry[KEYS[kind]]), unit = fit(UNIT_OF[kind], Math.max(...vectors.map(({ major }) => major)));
      head.push(`${kind}, ${unit.name}`, "with crank", "against");
      vectors.forEach((vector, k) => rows[k].push(...writeVector(vector, shown[k].order, unit)));
    }
    return { head, rows, words: [0] };
  }
  // What cancels an order, in a few words; none for a small one.
  function tellCures({ verdict, page }, order) {
    const finding = verdict.matter.find((each) => each.order === order);
    if (!finding) return "";
    if (order > 2) return "usually left";
    if (!finding.cures && !page.crossheads) return "no device is named";  // uneven speed, half orders, shafts of locomotives
    if (!finding.cures) return order > 1 ? "compensators" : "counterweights, compensators";
    const back = finding.cures.filter((cure) => cure.takes_back), told = back.length ? back : finding.cures;
    return told.map(nameCure).join(", ") || "no part is worth a shaft";
  }
  function nameCure({ ratio, on_crank, further, takes_back }) {
    if (takes_back) return "counterweights would take back those of the file";
    const device = on_crank ? "counterweights" : `shaft at ${ratio > 0 ? "+" : ""}${ratio}`;
    return further ? `further ${device}` : device;
  }
  const addCures = (figures, { head, rows, words }) => ({
    head: [...head, "cancelled by"], words: [...words, head.length],
    rows: rows.map((row, k) => [...row, tellCures(figures, listOrders(figures)[k].order)]),
  });

  // The couple by order, where it is not negligible; no rows if it is nowhere.
  function makeAbout(figures) {
    const least = limits.worthNaming * figures.page.scales.roll_Nm * (1 - 1e-9);
    const shown = figures.orders.filter(({ order, couple_Nm: couple }) => order > 0 && couple.amplitude && couple.amplitude >= least);
    const unit = fit(units.moment, Math.max(0, ...shown.map(({ couple_Nm: couple }) => couple.amplitude)));
    const rows = shown.map(({ order, couple_Nm: couple }) =>
      [orderName(order), number(couple.amplitude / unit.size), degrees(couple.peak_deg)]);
    return { head: ["order", "couple C", "peak, deg"], rows, words: [0], unit: unit.name };
  }

  // Roll by order, and the largest force and moment over a revolution, as pairs of name and text.
  function listLargest(figures, gas) {
    const least = limits.negligible * figures.page.scales.roll_Nm, sizes = figures.orders.map(({ order, roll_Nm: roll }) => [order, roll.amplitude]);
    const largest = Math.max(0, ...sizes.map(([, each]) => each)), unit = fit(units.moment, largest);
    const shown = sizes.filter(([, each]) => each > least).map(([order, each]) => `${orderName(order)}: ${number(each / unit.size)}`);
    const roll = shown.length ? `order ${shown.join(", ")} ${unit.name}` : smallText(largest, units.moment);
    const told = kindsOf(figures).map((kind) => [kind, tellPeak(figures, kind)]);
    if (!known(figures)) told.push(["moment", UNKNOWN]);
    return [[gas ? "roll moment, inertia alone" : "roll moment", roll], ...told];
  }
  function tellPeak(figures, kind) {
    const value = figures.peak[KEYS[kind]], at = figures.peak[`${kind}_deg`], every = figures.page.every[kind];
    if (!value || value < limits.negligible * scaleOf(figures, kind)) return smallText(value, UNIT_OF[kind]);
    const told = sizeText(value, UNIT_OF[kind], 5);
    if (!every) return `${told} at every crank angle`;
    return `${told} at crank angle ${degrees(at)} deg${every < 360 - 1e-6 ? ` and every ${Number(every.toPrecision(6))} deg` : ""}`;
  }

  // ------------------------------------------------------------------ ladder and devices
  function sizeColumn(figures, values, kind) {
    const unit = fit(UNIT_OF[kind], Math.max(...values)), scale = scaleOf(figures, kind);
    const cells = values.map((value) => {
      if (value <= TINY * scale) return BALANCED;
      return value < limits.negligible * scale ? SMALLEST : number(value / unit.size);
    });
    return { unit, cells };
  }
  function makeLadder(figures) {
    const { steps } = figures.ladder, head = ["step"], rows = steps.map(({ step }, k) => [`${k} ${step}`]);
    const put = (title, cells) => { head.push(title); cells.forEach((cell, k) => rows[k].push(cell)); };
    for (const kind of kindsOf(figures)) {
      const { unit, cells } = sizeColumn(figures, steps.map((step) => step[`peak_${KEYS[kind]}`]), kind);
      put(`${kind}, ${unit.name}`, cells);
    }
    if (steps[0].main_bearing_N !== undefined) {
      const { unit, cells } = sizeColumn(figures, steps.map((step) => step.main_bearing_N), "force");
      put(`main bearing, ${unit.name}`, cells);
    }
    put("weights", steps.map((step) => String(step.counterweights || UNKNOWN)));
    put("shafts", steps.map((step) => String(step.shafts || UNKNOWN)));
    put(`steel, ${units.mass.name}`, steps.map((step) => step.steel_kg ? number(step.steel_kg / units.mass.size, 3) : UNKNOWN));
    return { head, rows, words: [0] };
  }
  function makeDevices({ devices }) {
    const unit = fit(units.unbalance, Math.max(0, ...devices.map((d) => d.unbalance_kg_m))), length = (mm) => number(mm / 1e3 / units.length.size);
    const rows = devices.map((d) => [
      d.device, d.device === "counterweight" ? "1" : `${d.ratio > 0 ? "+" : ""}${d.ratio}`, number(d.unbalance_kg_m / unit.size),
      d.device === "counterweight" ? `${degrees(d.angle_deg)} from pin 1` : degrees(d.angle_deg),
      d.device === "counterweight" ? "crank axis" : d.free ? "free" : d.at_mm.map(length).join(", "), length(d.position_mm),
    ]);
    return { head: ["device", "speed ratio", unit.name, "angle, deg", `x, y, ${units.length.name}`, `z, ${units.length.name}`], rows, words: [0, 3, 4] };
  }

  // ------------------------------------------------------------------ facts of an engine of the kernel
  // Names and texts of the head, but for those that need Python's words (firing, numbering, assumed values).
  function listFacts(engine, data) {
    const length = (value, digits) => number(value / units.length.size, digits), mm = units.length.name;
    const { cylinders } = engine, first = cylinders.find(({ number: n }) => n === 1);
    const others = areEqual(cylinders) ? "" : " (cylinder 1; others differ)";
    const facts = [["cylinders", `${cylinders.length}${tellBanks(engine)}${tellBore(engine, data, first, length)}`]];
    const lambda = first.r / first.l, ratio = number(lambda, lambda < 0.999 ? 4 : 7);
    facts.push(["crank", `r = ${length(first.r)} ${mm}, rod ${length(first.l)} ${mm}, λ = ${ratio}${others}`]);
    facts.push(["throws", tellThrows(engine)]);
    facts.push(["speed", `${number(data.speed, 6)} rpm`]);
    facts.push(["masses", tellMasses(engine, data, first) + others]);
    facts.push(["devices", engine.devices.length ? `${engine.devices.length} from the file included` : ""]);
    return facts.filter(([, text]) => text);
  }
  const areEqual = ([one, ...others]) => others.every((c) => ["r", "l", "e", "reciprocating"].every((key) => c[key] === one[key]));
  function tellBanks({ cylinders }) {
    const axes = [...new Map(cylinders.map((c) => [c.bank, c.axis])).values()].map((axis) => number(axis * 180 / Math.PI + 0));
    if (axes.length === 1) return " in line";
    return `, banks at ${axes.slice(0, 9).join(", ")}${axes.length > 9 ? " …" : ""} deg`;
  }
  function tellBore({ bore, cylinders, r, fires }, data, first, length) {
    if (!bore) return "";
    const travelOf = ({ r, l, e }) => Math.sqrt((l + r) ** 2 - e ** 2) - Math.sqrt((l - r) ** 2 - e ** 2);
    const burning = cylinders.filter(({ number: n }) => !data.fires || data.fires.includes(n));
    const volume = Math.PI / 4 * bore ** 2 * burning.reduce((total, c) => total + travelOf(c), 0), unit = fit(units.volume, volume);
    const nominal = length(2 * first.r), true_ = length(travelOf(first)), mm = units.length.name;
    const stroke = `${length(2 * r, 5)} ${mm}${true_ === nominal ? "" : ` (true stroke ${true_} ${mm})`}`;
    return `, bore × stroke ${length(bore, 5)} × ${stroke}, ${number(volume / unit.size)} ${unit.name}`;
  }
  function tellThrows({ cylinders }) {
    const start = cylinders.find(({ number: n }) => n === 1), turn = 180 / Math.PI, pins = new Map();
    for (const c of cylinders) pins.set(c.throw, [...(pins.get(c.throw) || []), (c.axis + c.psi - start.axis - start.psi) * turn]);
    const throws = [...pins].sort(([a], [b]) => a - b).map(([, angles]) => angles), [own, next] = throws[0];
    const round = (value, digits) => Number(value.toFixed(digits)), wrap = (angle, from) => ((angle - from) % 360 + 360) % 360 + from;
    const lead = next === undefined ? 0 : round(wrap(next - own, -180), 6);
    if (throws.length === 1 && !lead) return "";
    const angles = throws.map(([angle]) => number(wrap(round(round(angle, 6), 1), 0), 6));
    const begin = angles[0] === "0" ? "" : " from cylinder 1's pin";
    const splay = lead ? `, split pins: the next bank's pin at ${lead > 0 ? "+" : ""}${number(lead, 6)} deg` : "";
    return `${angles.slice(0, 12).join(", ")}${angles.length > 12 ? ", …" : ""} deg${begin}${splay}`;
  }
  function tellMasses({ cylinders, throws }, data, first) {
    const kg = (value) => `${number(value / units.mass.size)} ${units.mass.name}`, throwOf = (c) => throws.findIndex(({ files }) => files.includes(c.throw));
    const pinOf = (c) => `${throwOf(c)} ${Math.round((c.axis + c.psi) * 1e8)} ${c.r}`;
    const sharing = cylinders.filter((c) => pinOf(c) === pinOf(first)), all = sharing.reduce((total, c) => total + c.rotating, 0);
    const pin = sharing.length > 1 ? ` (${number(all / units.mass.size)} per pin of ${sharing.length} rods)` : "";
    return `reciprocating ${kg(first.reciprocating)} per cylinder, rotating ${kg(first.rotating)} per rod${pin}`;
  }

  // ------------------------------------------------------------------ markup
  const make = (tag, attributes = {}, ...children) => {
    const made = document.createElement(tag);
    Object.assign(made, attributes);
    made.append(...children);
    return made;
  };
  // Fills a table of the page, in the markup of the template.
  function fill(table, { head, rows, words }) {
    const side = (k) => words.includes(k) ? { className: "words" } : {};
    const heads = head.map((text, k) => make("th", { scope: "col", ...side(k) }, text));
    const body = rows.map((row) => make("tr", {}, ...row.map((cell, k) => {
      const text = cell === BALANCED ? make("b", { className: "ok" }, cell) : cell;
      return k ? make("td", side(k), text) : make("th", { scope: "row", ...side(k) }, text);
    })));
    table.replaceChildren(make("thead", {}, make("tr", {}, ...heads)), make("tbody", {}, ...body));
  }
  const fillFacts = (list, pairs) => list.replaceChildren(...pairs.map(([name, text, className = ""]) =>
    make("div", { className }, make("dt", {}, name), make("dd", {}, text))));

  return {
    number, degrees, orderName, fit, sizeText, smallText, known, kindsOf, scaleOf, listOrders, tellCures, nameCure, makeOrders, addCures, makeAbout,
    listLargest, makeLadder, makeDevices, listFacts, fill, fillFacts, make, UNIT_OF, KEYS, units, limits, BALANCED,
  };
})();
