"use strict";
// The page: shows a document of figures with the devices of the chosen step, in motion. Nothing here computes an engine:
// `Page.show` gets figures from Python, or from the kernel after a change.
const Page = (() => {
  const {
    make, number, fit, orderName, sizeText, smallText, kindsOf, isNegligible, scaleOf, KEYS, UNIT_OF, units, limits, BALANCED,
  } = Tables;
  const DEGREES_PER_SECOND = 60;
  const RARE = 125;                                           // ms between changes of texts while a slider moves
  const TITLES = { force: "Free force", moment: "Free moment" };
  const SI = { force: "N", moment: "N m" };
  const LARGE = 0.05;                                         // shares of force and moment from which both are shown large,
  const FACTOR = 5;                                           // if they differ by less than this factor
  const ROUNDING = 1e-11;                                     // share of one cylinder's value; less counts as balanced
  const FEW_BARS = 4;                                         // as many fit in the room of any engine
  const DEGREES = Array.from({ length: 361 }, (_, k) => k);
  const NONE = [0, 0];
  const byId = (id) => document.getElementById(id);
  const read = (id) => byId(id) && JSON.parse(byId(id).textContent);
  const rad = (degrees) => degrees * Math.PI / 180;
  const total = ([ahead, against]) => ahead + against;

  const settings = read("page");
  const ofFile = read("figures");                             // what Python wrote
  let { look, file } = settings;
  let figures = ofFile;                                       // what the page shows
  let unchanged = ofFile;                                     // figures of the shown engine without changes
  let scene = read("scene");
  let changed = false;                                        // whether the figures are not those that Python wrote
  let compared = false;                                       // whether the reader changed the engine
  let asked = null;                                           // name of the choice that the reader made
  let chosen = null;                                          // its place among the choices
  let theta = 0;                                              // crank angle

  // ------------------------------------------------------------------ choices: steps of the ladder, and some more
  const listChoices = () => [...figures.ladder.steps, ...figures.page.extra];
  const isStep = (k) => k < figures.ladder.steps.length;
  const valueOf = (k) => isStep(k) ? String(k) : listChoices()[k].step.split(/[ :]/)[0];
  const labelOf = ({ step }, k) => isStep(k) ? `${k}: ${step}` : step;
  const nameChoice = (k) => isStep(k) ? `step ${k}` : listChoices()[k].step.replace("default: ", "");   // in a sentence
  const isScheme = ({ step }) => step.startsWith("scheme ");
  const tellSteps = () => `step: this engine has steps 0 to ${figures.ladder.steps.length - 1}`;

  function findChosen() {
    const wanted = listChoices().findIndex((_, k) => valueOf(k) === asked);
    return wanted >= 0 ? wanted : findUsual();
  }
  // The choice with the scheme of the page, or with the steps that are fitted by default.
  function findUsual() {
    const { steps, auto } = figures.ladder;
    const { extra } = figures.page;
    const scheme = extra.findIndex(isScheme);
    if (scheme >= 0) return steps.length + scheme;
    const several = extra.findIndex(({ step }) => step.startsWith("default"));
    if (several >= 0) return steps.length + several;
    return Math.max(0, steps.findIndex(({ step }) => step === auto.at(-1)));
  }
  // Choices that hold only for the engine of the file: a scheme is not computed by the page.
  const listStale = () => changed ? ofFile.page.extra.filter(isScheme) : [];

  function showChoices() {
    const labels = listChoices().map(labelOf);
    const stale = listStale().map(({ step }) => step);
    const field = byId("steps");
    const shown = JSON.stringify([labels, stale]);
    if (field.dataset.shown !== shown) {
      field.dataset.shown = shown;
      const chips = labels.map(makeChip);
      field.replaceChildren(field.querySelector("legend"), ...chips, ...stale.map(makeStaleChip));
      field.scrollLeft = chips[chosen].offsetLeft - field.offsetLeft - 12;   // on a phone
    }
    field.querySelectorAll("input").forEach((input, k) => {
      input.checked = k === chosen;
      input.parentElement.classList.toggle("on", input.checked);
    });
  }
  function makeChip(label, k) {
    const input = make("input", { type: "radio", name: "step", value: valueOf(k) });
    input.addEventListener("change", () => choose(input.value));
    return make("label", { className: "chip" }, input, label);
  }
  function makeStaleChip(label) {
    const input = make("input", { type: "radio", name: "step", value: "scheme", disabled: true });
    return make("label", { className: "chip stale", title: "of the file without your changes" }, input, label);
  }
  function choose(value) {
    asked = value;
    document.dispatchEvent(new CustomEvent("step", { detail: value }));
    show(figures, { scene, changed, facts: null });
  }
  // On a page without sliders, the step is all of its address.
  function followAddress() {
    asked = location.hash.match(/[#&]step=([^&]*)/)?.[1] ?? null;
    const isWrong = asked !== null && !listChoices().some((_, k) => valueOf(k) === asked);
    if (isWrong) asked = null;
    byId("live-wrong").textContent = isWrong ? tellSteps() : "";
    show(figures, { scene, changed: false, atOnce: true });
  }
  function writeStep({ detail }) {
    try { history.replaceState(null, "", `#step=${detail}`); } catch { /* a frame of a notebook */ }
  }

  // ------------------------------------------------------------------ vectors of a step
  // To the axes of the drawing.
  function rotate([x, y]) {
    const cos = Math.cos(-rad(look.up || 0));
    const sin = Math.sin(-rad(look.up || 0));
    return [x * cos - y * sin, x * sin + y * cos];
  }
  // Orders of a force or moment as rows of [order, forward, backward], with the devices of a step.
  function listRows(document, kind, step) {
    const rows = new Map();
    for (const { order, [KEYS[kind]]: vector } of document.orders) {
      rows.set(order, vector ? [vector.forward, vector.backward] : [NONE, NONE]);
    }
    for (const change of step.changes) rows.set(change.order, change[kind]);
    return [...rows].map(([order, parts]) => [order, ...parts.map(rotate)]);
  }
  const rowsDrawn = (kind) => listRows(figures, kind, figures.ladder.steps[0]);
  const rowsNow = (kind) => listRows(figures, kind, listChoices()[chosen]);

  // Sizes of the vectors of an order that turn with the crank and against it.
  function sizesOf(rows, order) {
    const [, ...vectors] = rows.find(([n]) => n === order) || [order, NONE, NONE];
    return vectors.map(([x, y]) => Math.hypot(x, y));
  }
  const peakOf = (step, kind) => step[`peak_${KEYS[kind]}`];
  const stepDrawn = (document) => document.ladder.steps[0];
  // The row with the steps of a choice in the ladder without changes.
  function findUnchanged({ step }) {
    return unchanged.ladder.steps.find((other) => other.step === step) || stepDrawn(unchanged);
  }

  // Force or moment, or both: what is larger beside one cylinder's first order. Without changes, so that places on the
  // page stay while a slider moves.
  function rankKinds() {
    const shareOf = (kind) => peakOf(stepDrawn(unchanged), kind) / (scaleOf(unchanged, kind) || 1);
    const kinds = kindsOf(unchanged).sort((a, b) => shareOf(b) - shareOf(a));
    const [first, second] = kinds.map(shareOf);
    const both = second >= LARGE && first < FACTOR * second;
    return both ? { main: kinds, other: [] } : { main: kinds.slice(0, 1), other: kinds.slice(1) };
  }

  // ------------------------------------------------------------------ key figures
  function showKey() {
    const { main, other } = rankKinds();
    const step = listChoices()[chosen];
    const large = main.map((kind) => make("div", {},
      make("h2", {}, TITLES[kind]),
      make("p", { className: "big" }, ...writeChange(tellChange(figures, kind, step)))));
    byId("key-large").replaceChildren(...large);
    byId("key-with").textContent = tellChoice(step);
    byId("key-was").textContent = compared ? tellUnchanged(main, step) : "";
    const small = listSmallFigures(other, step).map(([title, parts]) => make("div", {}, make("h2", {}, title), make("p", {}, ...parts)));
    byId("key-small").replaceChildren(...small);
  }
  function listSmallFigures(kinds, step) {
    const entries = kinds.map((kind) => [TITLES[kind], writeChange(tellChange(figures, kind, step))]);
    if (kindsOf(figures).length < 2) entries.push(["Free moment", ["not known"]]);
    if (step.main_bearing_N !== undefined) entries.push(["Main bearing", writeChange(tellLoad(step))]);
    entries.push([titleRoll(), tellRoll()]);
    return entries;
  }
  function tellChoice(step) {
    if (chosen === 0) return "as drawn";
    const devices = tellDevices(step);
    return `as drawn → with ${nameChoice(chosen)}${devices && `: ${devices}`}`;
  }
  function tellDevices({ counterweights, shafts, steel_kg }) {
    const parts = [tellCount(counterweights, "counterweight"), tellCount(shafts, "shaft")];
    if (steel_kg) parts.push(`${number(steel_kg / units.mass.size, 3)} ${units.mass.name} of steel`);
    return parts.filter(Boolean).join(", ");
  }
  function tellCount(count, name) {
    if (!count) return "";
    return count > 1 ? `${count} ${name}s` : `${count} ${name}`;
  }
  function tellUnchanged(kinds, step) {
    const changes = kinds.map((kind) => tellChange(unchanged, kind, findUnchanged(step)));
    const texts = changes.map(({ texts: values, unit }) => `${values.join(" → ")} ${unit}`);
    return `${file || "file"}: ${texts.join("; ")}`;
  }

  // The largest force or moment as drawn, and with a step: { texts, unit }.
  function tellChange(document, kind, step) {
    const drawn = stepDrawn(document);
    const unit = columnUnit(document, kind);
    if (isNegligible(document, kind, peakOf(drawn, kind))) {
      return { texts: [tellSize(document, kind, peakOf(drawn, kind), unit)], unit: "" };
    }
    const states = step === drawn ? [drawn] : [drawn, step];
    return { texts: states.map((state) => tellBriefly(document, kind, peakOf(state, kind), unit)), unit: unit.name };
  }
  function tellBriefly(document, kind, value, unit) {
    if (!value) return BALANCED;
    return isNegligible(document, kind, value) ? "<0.1 %" : number(value / unit.size);
  }
  function columnUnit(document, kind) {
    const peaks = document.ladder.steps.map((step) => peakOf(step, kind));
    return fit(UNIT_OF[kind], Math.max(...peaks));
  }
  function tellSize(document, kind, value, unit) {
    return isNegligible(document, kind, value) ? smallText(value, UNIT_OF[kind]) : number(value / unit.size);
  }
  function writeChange({ texts: [before, after], unit }) {
    const parts = [make("span", { className: "before-text" }, before)];
    if (after !== undefined) parts.push(make("span", { className: "to" }, " → "), make("span", { className: "now-text" }, after));
    return [...parts, make("small", {}, unit && ` ${unit}`)];
  }
  function tellLoad(step) {
    const drawn = stepDrawn(figures);
    const loads = figures.ladder.steps.map(({ main_bearing_N }) => main_bearing_N || 0);
    const unit = fit(units.force, Math.max(...loads));
    const least = 1e-12 * scaleOf(figures, "force");
    const write = ({ main_bearing_N: load }) => load > least ? number(load / unit.size) : BALANCED;
    const states = chosen === 0 ? [drawn] : [drawn, step];
    return { texts: states.map(write), unit: unit.name };
  }
  // The roll that rocks the engine: with gas, if Python computed it. Of a changed engine, the page knows that of inertia.
  const hasRollWithGas = () => figures.ladder.roll?.of === "total";
  function titleRoll() {
    if (hasRollWithGas()) return "Roll with gas";
    return look.gas ? "Roll, inertia alone" : "Roll moment";
  }
  function tellRoll() {
    const { order, amplitude } = hasRollWithGas() ? findRollWithGas() : findRollOfInertia();
    if (amplitude <= limits.negligible * figures.page.scales.roll_Nm) return [smallText(amplitude, units.moment)];
    return [`${sizeText(amplitude, units.moment)} `, make("small", {}, `order ${orderName(order)}`)];
  }
  const findRollWithGas = () => ({ order: figures.ladder.roll.order, amplitude: figures.ladder.roll.amplitude_Nm });
  function findRollOfInertia() {
    const turning = figures.orders.filter(({ order }) => order > 0);
    const { order, roll_Nm } = turning.reduce((most, entry) => entry.roll_Nm.amplitude > most.roll_Nm.amplitude ? entry : most);
    return { order, amplitude: roll_Nm.amplitude };
  }

  // ------------------------------------------------------------------ charts of the chosen step
  const chartOf = (id, kind) => byId(`${id}-${kind}`);
  const TITLED = { bars: "by order", path: "over a revolution", turn: "over a revolution" };

  // Makes a figure of each of the main quantities for bars, path and curves.
  function prepareCharts() {
    const { main } = rankKinds();
    if (byId("bars").dataset.kinds === main.join()) return;
    byId("bars").dataset.kinds = main.join();
    byId("hero").classList.toggle("both", main.length > 1);
    for (const id of Object.keys(TITLED)) {
      byId(`${id}-charts`).replaceChildren(...main.map((kind) => prepareChart(id, kind)));
    }
  }
  function prepareChart(id, kind) {
    const isPath = id === "path";
    const svg = Charts.element("svg", { id: `${id}-${kind}`, role: "img" });
    svg.dataset.title = `${isPath ? "Path" : "Size"} of the ${TITLES[kind].toLowerCase()}`;
    const title = isPath ? `Path of the ${kind}` : `${TITLES[kind]} ${TITLED[id]}`;
    const caption = make("figcaption", {}, make("span", { id: `${id}-${kind}-title` }, title));
    const list = { bars: listBarRows, path: listPathRows, turn: listTurnRows }[id];
    Charts.addTools(caption, `${id}-${kind}`, () => svg, () => list(kind));
    return make("figure", {}, caption, svg);
  }
  function drawAllBars() {
    const counts = rankKinds().main.map(drawBars);
    keepRoom(Math.max(...counts));
  }

  // Orders from 1 to the highest that matters, with the sizes of both vectors before and after.
  function listBars(kind) {
    const least = limits.negligible * scaleOf(figures, kind);
    const large = figures.orders.filter(({ order, [KEYS[kind]]: vector }) => order >= 1 && vector.major > least);
    const last = Math.max(2, ...large.map(({ order }) => order));
    const before = rowsDrawn(kind);
    const after = rowsNow(kind);
    return Array.from({ length: last }, (_, k) => ({
      order: k + 1,
      before: sizesOf(before, k + 1),
      after: chosen ? sizesOf(after, k + 1) : null,
    }));
  }
  // Draws the bars of a quantity, and returns how many there are.
  function drawBars(kind) {
    const bars = listBars(kind);
    const sizes = bars.flatMap(({ before, after }) => after ? [total(before), total(after)] : [total(before)]);
    const largest = Math.max(...sizes);
    const unit = fit(UNIT_OF[kind], largest);
    const svg = chartOf("bars", kind);
    svg.setAttribute("aria-label", `${TITLES[kind]} by order`);
    chartOf("bars", `${kind}-title`).textContent = `${TITLES[kind]} by order, ${unit.name}`;
    Charts.drawBars(svg, bars.map((bar) => describeBar(kind, bar, unit)), largest);
    return bars.length;
  }
  // A bar without the sizes that are balanced, with texts of both, and what cancels it.
  function describeBar(kind, bar, unit) {
    const { order, before, after } = bar;
    const rounding = ROUNDING * scaleOf(figures, kind);
    const isBalanced = (parts) => total(parts) <= rounding;
    const write = (parts) => isBalanced(parts) ? BALANCED : number(total(parts) / unit.size);
    const stays = isBalanced(before) && (!after || isBalanced(after));
    const isAfterShown = after && !stays;
    return {
      order,
      before: isBalanced(before) ? null : before,
      after: isAfterShown ? after : null,
      told: isAfterShown ? [write(before), write(after)] : [write(before)],
      cure: isBalanced(before) ? "" : tellCure(kind, bar, unit),
    };
  }
  // What cancels the parts of an order: "counterweights: 2270, shaft at -1: 464.4".
  function tellCure(kind, { order, before: [ahead, against] }, unit) {
    const finding = figures.verdict.matter.find((other) => other.order === order);
    if (!finding || !finding.large.includes(kind)) return "too small for a device";
    const { cures } = finding;
    const hasParts = order <= 2 && cures?.length && !cures.some((cure) => cure.takes_back);
    if (!hasParts) return Tables.tellCures(figures, order);
    const sizeOf = (cure) => cure.ratio > 0 ? ahead : against;
    const cancelling = cures.filter((cure) => sizeOf(cure) > ROUNDING * scaleOf(figures, kind));
    return cancelling.map((cure) => `${Tables.nameCure(cure)}: ${number(sizeOf(cure) / unit.size)}`).join(", ");
  }
  // Keeps the room of the most bars that an engine had, so that bars that go move nothing below them.
  const room = { engine: null, bars: 0 };
  function keepRoom(count) {
    const most = room.engine === unchanged ? Math.max(count, room.bars) : count;
    if (room.engine === unchanged && room.bars === most) return;
    Object.assign(room, { engine: unchanged, bars: most });
    byId("bars-charts").style.minHeight = most > FEW_BARS ? `calc(${Charts.ROW * most}px + 1.9rem)` : "";
  }

  function drawPath(kind) {
    const step = listChoices()[chosen];
    const now = rowsNow(kind);
    const paths = { before: Charts.tracePath(rowsDrawn(kind)) };
    if (chosen) paths.now = Charts.tracePath(now);
    if (compared) paths.file = Charts.tracePath(listRows(unchanged, kind, findUnchanged(step)));
    const { texts: [before, after] } = tellChange(figures, kind, step);
    const svg = chartOf("path", kind);
    const { place, put } = Charts.drawPath(svg, paths, { names: look.names[kind], labels: { before, now: after }, theta, rows: now });
    svg.setAttribute("aria-label", `Path of the ${TITLES[kind].toLowerCase()} over a revolution`);
    if (byId("chain").checked) drawChain(now, place, put);
  }
  // The two turning vectors of each order, one after the other.
  function drawChain(rows, place, put) {
    let at = NONE;
    const drawLink = (way, row) => {
      const [x, y] = Charts.vectorAt([row], theta);
      const end = [at[0] + x, at[1] + y];
      put("path", { class: `chain ${way}`, d: `M${place(at)}L${place(end)}` });
      at = end;
    };
    for (const [order, forward, backward] of rows) {
      drawLink("ahead", [order, forward, NONE]);
      drawLink("behind", [order, NONE, backward]);
    }
  }

  // ------------------------------------------------------------------ curves over a revolution
  const sizeOverTurn = (rows) => DEGREES.map((degree) => Math.hypot(...Charts.vectorAt(rows, rad(degree))));
  function listTurnLines(kind) {
    const lines = [{ name: "as drawn", kind: "before", values: sizeOverTurn(rowsDrawn(kind)) }];
    if (chosen) lines.push({ name: `with ${nameChoice(chosen)}`, kind: "now", values: sizeOverTurn(rowsNow(kind)) });
    return lines;
  }
  const ABOUT = [["couple C", "couple", "couple_Nm"], ["inertia torque T", "torque", "inertia_torque_Nm"], ["roll C − T", "sum", "roll_Nm"]];
  function listAboutLines() {
    return ABOUT.map(([name, kind, key]) => ({ name, kind, values: DEGREES.map((degree) => sumOrders(key, rad(degree))) }));
  }
  function sumOrders(key, angle) {
    let value = 0;
    for (const { order, [key]: { cos, sin } } of figures.orders) {
      value += cos * Math.cos(order * angle) + sin * Math.sin(order * angle);
    }
    return value;
  }
  // Draws curves in the unit that fits the largest value.
  function drawFitting(svg, unit, lines) {
    const sizes = lines.flatMap(({ values }) => values.map(Math.abs));
    const fitting = fit(unit, Math.max(...sizes));
    const scaled = lines.map((line) => ({ ...line, values: line.values.map((value) => value / fitting.size) }));
    Charts.drawCurves(svg, { end: 360, unit: fitting.name, lines: scaled });
  }
  const drawTurns = () => rankKinds().main.forEach((kind) => drawFitting(chartOf("turn", kind), UNIT_OF[kind], listTurnLines(kind)));
  const drawAbout = () => drawFitting(byId("about-curve"), units.moment, listAboutLines());

  // ------------------------------------------------------------------ stars, and paths of the ladder
  const stars = new Map();                                    // figures by order and direction, with the present rays
  function drawStars() {
    const shown = figures.stars.map(({ order, turns, banks }) => {
      const name = `order ${order}, ${turns === "forward" ? "with the crank" : "against it"}`;
      if (!stars.has(name)) stars.set(name, makeStar(name, order, turns));
      const star = stars.get(name);
      star.banks = banks;
      Charts.drawStar(star.svg, listRays(banks));
      return star.figure;
    });
    replaceIfOthers(byId("stars-charts"), shown);
  }
  function makeStar(name, order, turns) {
    const svg = Charts.element("svg", { role: "img", "aria-label": `Star of order ${order}, ${turns}` });
    const caption = make("figcaption", {}, make("span", {}, name));
    const star = { svg, figure: make("figure", {}, caption, svg), banks: [] };
    Charts.addTools(caption, `star-${order}-${turns}`, () => svg, () => listStarRows(star.banks));
    return star;
  }
  function listRays(banks) {
    const ofBank = ({ cylinders }, bank) => cylinders.filter(({ force_N }) => force_N).map((ray) => ({
      vector: rotate([ray.force_N * Math.cos(rad(ray.force_deg)), ray.force_N * Math.sin(rad(ray.force_deg))]),
      label: ray.cylinder,
      bank,
    }));
    return banks.flatMap(ofBank);
  }
  const ladderPaths = [];                                     // figures of the rows
  function drawLadderPaths() {
    const [kind] = rankKinds().main;
    const unit = columnUnit(figures, kind);
    const { steps } = figures.ladder;
    steps.forEach((step, k) => {
      ladderPaths[k] ??= makeLadderPath();
      const { svg, caption } = ladderPaths[k];
      const value = peakOf(step, kind);
      const nameOfUnit = isNegligible(figures, kind, value) ? "" : unit.name;
      svg.setAttribute("aria-label", `Path of the ${kind} with step ${k}, to its own scale`);
      Charts.drawPath(svg, { [k ? "now" : "before"]: Charts.tracePath(listRows(figures, kind, step)) }, { names: look.names[kind], wide: 90 });
      caption.textContent = `${k}: ${tellSize(figures, kind, value, unit)} ${nameOfUnit}`;
    });
    replaceIfOthers(byId("ladder-paths"), ladderPaths.slice(0, steps.length).map(({ figure }) => figure));
  }
  function makeLadderPath() {
    const svg = Charts.element("svg", { role: "img" });
    const caption = make("figcaption", {});
    return { svg, caption, figure: make("figure", {}, svg, caption) };
  }
  // Elements that stay where they are cost no new layout.
  function replaceIfOthers(parent, children) {
    const isSame = parent.children.length === children.length && children.every((child, k) => parent.children[k] === child);
    if (!isSame) parent.replaceChildren(...children);
  }

  // ------------------------------------------------------------------ data of charts as CSV
  const headOf = (name, kind) => `${name}, ${kind}, ${SI[kind]}`;
  const listCurveRows = (heads, lines) => [
    ["crank angle, deg", ...heads],
    ...DEGREES.map((degree) => [degree, ...lines.map(({ values }) => values[degree])]),
  ];
  function listBarRows(kind) {
    const names = ["as drawn with crank", "as drawn against", "now with crank", "now against"];
    const rows = listBars(kind).map(({ order, before, after }) => [order, ...before, ...(after || before)]);
    return [["order", ...names.map((name) => headOf(name, kind))], ...rows];
  }
  function listPathRows(kind) {
    const states = { "as drawn": rowsDrawn(kind), now: rowsNow(kind) };
    const heads = Object.keys(states).flatMap((state) => look.names[kind].map((name) => headOf(`${state}: ${name}`, kind)));
    const listValues = (degree) => Object.values(states).flatMap((rows) => Charts.vectorAt(rows, rad(degree)));
    return [["crank angle, deg", ...heads], ...DEGREES.map((degree) => [degree, ...listValues(degree)])];
  }
  function listTurnRows(kind) {
    const lines = listTurnLines(kind);
    return listCurveRows(lines.map(({ name }) => headOf(name, kind)), lines);
  }
  function listAboutRows() {
    const lines = listAboutLines();
    return listCurveRows(lines.map(({ name }) => `${name}, N m`), lines);
  }
  function listStarRows(banks) {
    const rays = banks.flatMap(({ cylinders }) => cylinders);
    return [["cylinder", "force, N", "direction, deg"], ...rays.map((ray) => [ray.cylinder, ray.force_N, ray.force_deg ?? ""])];
  }
  const listTable = (id) => [...byId(id).rows].map((row) => [...row.cells].map((cell) => cell.textContent));

  // ------------------------------------------------------------------ tables
  let areTablesOfPage = false;                                // whether Python's tables were replaced
  function showTables(facts) {
    if (facts) Tables.fillFacts(byId("facts"), facts);
    if (changed || areTablesOfPage) {
      areTablesOfPage = true;
      showFollowingTables();
    }
    Tables.fill(byId("orders-table"), Tables.addCures(figures, Tables.makeOrders(figures)));
    Tables.fill(byId("devices-table"), Tables.makeDevices(listChoices()[chosen]));
    byId("devices-title").textContent = chosen ? `Devices of ${nameChoice(chosen)}` : "Devices: choose a step above";
    byId("devices-table").hidden = !chosen;
    markLadder();
  }
  // Marks the chosen step, and the steps that are fitted by default.
  function markLadder() {
    const { auto, steps } = figures.ladder;
    [...byId("ladder-table").tBodies[0].rows].forEach((row, k) => {
      row.classList.toggle("sel", k === chosen);
      row.classList.toggle("auto", auto.includes(steps[k].step));
    });
  }
  function showFollowingTables() {
    const title = byId("ladder").querySelector("h2").firstChild;
    title.data = title.data.replace(/\(.* rpm\)/, `(${number(figures.speed_rpm, 6)} rpm)`);
    Tables.fill(byId("ladder-table"), Tables.makeLadder(figures));
    const about = Tables.makeAbout(figures);
    Tables.fill(byId("about-table"), about);
    byId("about").querySelector("h2 small").textContent = about.unit;
    byId("about").classList.toggle("nothing", !about.rows.length);
    Tables.fillFacts(byId("largest-list"), Tables.listLargest(figures, look.gas));
  }

  // ------------------------------------------------------------------ the drawing
  const drawing = { turn: null, of: "" };                     // how it turns, and what it shows
  // Draws the engine anew if its parts or places differ from those of the drawing.
  function prepareDrawing() {
    if (!scene) return;
    const devices = listDevices();
    const places = devices.map(({ at, z, kind, order, forward }) => [at, z, kind, order, forward.some(Boolean)]);
    const shown = JSON.stringify([scene, look.axes, places]);
    if (drawing.of !== shown) Object.assign(drawing, { turn: Mechanism.draw(scene, devices, look.axes), of: shown });
  }
  // Devices of the engine and of the choice, in the axes of the drawing.
  function listDevices() {
    const devices = [...figures.page.devices, ...listChoices()[chosen].devices];
    const inGramMillimetres = (vector) => rotate(vector).map((value) => 1e6 * value);
    return devices.map((device) => ({
      ...device,
      at: rotate(device.at_mm),
      z: device.position_mm,
      forward: inGramMillimetres(device.forward),
      backward: inGramMillimetres(device.backward),
    }));
  }
  function turn() {
    const angle = Number(byId("angle").value);
    theta = rad(angle);
    byId("angle-now").textContent = `${Math.round(angle)}°`;
    const { main } = rankKinds();
    if (scene) drawing.turn(angle, findShake(main[0]), listDevices());
    main.forEach(drawPath);
    document.dispatchEvent(new CustomEvent("crank", { detail: angle }));
  }
  // The force or moment of the choice at the crank angle, and the largest over a revolution; 0 if it is small.
  function findShake(kind) {
    const most = peakOf(listChoices()[chosen], kind);
    return { kind, vector: Charts.vectorAt(rowsNow(kind), theta), largest: isNegligible(figures, kind, most) ? 0 : most };
  }

  // ------------------------------------------------------------------ show
  // Shows figures and the engine of a scene; `facts` are pairs for the head, null if they stay.
  // `engine` has the figures of the engine without changes, and `shown` how to draw it and the name of its file.
  function show(next, { scene: mechanism, changed: differs, compared: against = compared, facts = null, engine = unchanged, shown = { look, file }, atOnce = false }) {
    figures = next;
    scene = mechanism;
    changed = differs;
    compared = against;
    unchanged = engine;
    ({ look, file } = shown);
    chosen = findChosen();
    prepareCharts();
    if (isParked) park();
    showChoices();
    showKey();
    drawAllBars();
    prepareDrawing();
    turn();
    showRarely(facts, atOnce);
  }
  // Tables and the charts below follow at once, but while a slider moves only a few times in a second, in a task of
  // their own, and at last.
  let lastShow = -RARE;
  let lastRest = -RARE;
  let due = null;
  let newFacts = null;
  function showRarely(facts, atOnce) {
    const now = performance.now();
    const isAlone = now - lastShow >= RARE;
    lastShow = now;
    newFacts = facts || newFacts;
    if (atOnce || isAlone) showRest();
    else due ??= setTimeout(showRest, Math.max(0, RARE - (now - lastRest)));
  }
  function showRest() {
    clearTimeout(due);
    due = null;
    lastRest = performance.now();
    showTables(newFacts);
    newFacts = null;
    drawTurns();
    drawAbout();
    drawLadderPaths();
    drawStars();
  }

  // ------------------------------------------------------------------ start
  // The drawing stands at the angle of the largest value if the reader wants no motion.
  let isParked = matchMedia("(prefers-reduced-motion: reduce)").matches;
  function park() {
    byId("angle").value = Math.round(figures.peak[`${rankKinds().main[0]}_deg`] || 0);
  }
  function startMotion() {
    const angle = byId("angle");
    const play = byId("play");
    const isSeen = () => byId("hero").getBoundingClientRect().bottom > 0;
    const advance = (degrees) => {
      angle.step = "any";
      angle.value = (Number(angle.value) + degrees) % Number(angle.max);
      if (isSeen()) turn();
    };
    const stop = () => {
      angle.step = "1";
      angle.value = Math.round(Number(angle.value));
      turn();
    };
    const leavePark = () => { isParked = false; };
    play.addEventListener("click", leavePark);
    angle.addEventListener("input", leavePark);
    angle.addEventListener("input", turn);
    byId("chain").addEventListener("change", turn);
    Motion.attach(play, DEGREES_PER_SECOND, advance, stop);
    if (isParked) park();
    else play.click();
  }
  function startTheme() {
    const theme = byId("theme");
    const root = document.documentElement;
    theme.hidden = false;
    theme.addEventListener("click", () => {
      const usual = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
      root.dataset.theme = (root.dataset.theme || usual) === "dark" ? "light" : "dark";
    });
  }
  // Curves of the file: torque and pressure of gas over the cycle, motion of a piston over a revolution.
  function listFileCurves() {
    const running = read("running");
    const motion = read("motion");
    const ofGas = (running?.curves || []).map((curve) => ({ ...curve, end: running.cycle }));
    const ofPiston = (motion?.curves || []).map((curve) => ({ ...curve, end: 360 }));
    return [...ofGas, ...ofPiston].map((curve) => ({ ...curve, svg: byId(`${curve.id}-curve`), lines: listFileLines(curve) }));
  }
  const fileCurves = listFileCurves();
  const drawFileCurves = () => fileCurves.forEach(({ svg, end, unit, lines }) => Charts.drawCurves(svg, { end, unit, lines }));
  function listFileRows({ end, unit, total: values, lines }) {
    const step = end / (values.length - 1);
    const heads = lines.map(({ name }) => `${name}, ${unit}`);
    const rows = values.map((_, k) => [k * step, ...lines.map((line) => line.values[k])]);
    return [["crank angle, deg", ...heads], ...rows];
  }
  function listFileLines({ title, total: values, gas, mean, crank_end: crankEnd }) {
    if (gas) {
      return [
        { name: "total", kind: "sum", values },
        { name: "gas", kind: "gas", values: gas },
        { name: "mean", kind: "before", values: gas.map(() => mean) },
      ];
    }
    if (crankEnd) return [{ name: "head end", kind: "now", values }, { name: "crank end", kind: "gas", values: crankEnd }];
    return [{ name: title || "pressure", kind: "now", values }];
  }
  // Pictures of torsion, which Python drew: SVG texts, packed.
  async function showTorsion() {
    const packed = byId("torsion-packed");
    if (!packed) return;
    for (const svg of JSON.parse(await Packed.unpack(packed.textContent))) {
      const figure = make("figure", { tabIndex: 0 });         // it scrolls on a phone
      figure.innerHTML = svg;
      byId("torsion-pictures").append(figure);
    }
  }
  function addTools() {
    const addCsv = (id) => Charts.addTools(byId(id).querySelector("h2"), id, null, () => listTable(`${id}-table`));
    addCsv("orders");
    addCsv("ladder");
    const addToCurve = (id, listRows) => {
      const svg = byId(`${id}-curve`);
      Charts.addTools(svg.parentElement.querySelector("figcaption"), id, () => svg, listRows);
    };
    addToCurve("about", listAboutRows);
    for (const curve of fileCurves) addToCurve(curve.id, () => listFileRows(curve));
  }
  function drawAgain() {
    drawFileCurves();
    show(figures, { scene, changed, atOnce: true });
  }
  function followWidth() {
    let width = innerWidth;
    addEventListener("resize", () => {
      if (innerWidth === width) return;
      width = innerWidth;
      Charts.forgetWidths();
      drawAgain();
    });
  }
  function followPaper() {
    for (const [event, isOnPaper] of [["beforeprint", true], ["afterprint", false]]) {
      addEventListener(event, () => {
        Charts.drawForPaper(isOnPaper);
        drawAgain();
      });
    }
  }
  function start() {
    addTools();
    prepareCharts();
    startMotion();
    startTheme();
    drawFileCurves();
    showTorsion();
    show(ofFile, { scene, changed: false, atOnce: true });
    if (!byId("live")) {
      followAddress();
      addEventListener("hashchange", followAddress);
      document.addEventListener("step", writeStep);
    }
    followWidth();
    followPaper();
  }
  const listValues = () => [...listChoices().map((_, k) => valueOf(k)), ...listStale().map(() => "scheme")];

  return {
    show, start, choose, turn, tellSteps, ofFile,
    get devices() { return listChoices()[chosen].devices; },
    get steps() { return listValues(); },
    set asked(value) { asked = value; },
  };
})();
Page.start();
