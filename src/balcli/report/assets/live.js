"use strict";
// Numbers to drag, the state in the address, and files to take away.
(() => {
  const byId = (id) => document.getElementById(id);
  const book = JSON.parse(byId("live").textContent);          // engines by name, units, new devices
  const TITLES = { crank: "Crank", rod: "Rods", piston: "Pistons", layout: "Layout", operation: "Speed" };
  const DEVICE = /^(counterweight|shaft|slider)\.([1-9]\d*)(?:\.(.+))?$/;
  const GEOMETRY = /^(crank\.(throws|splay)|layout\.(bank_angle|banks))|\.(bank|throw)$/;   // what a firing order depends on
  const MAIN = ["layout.bank_angle", "rod.length", "rod.ratio", "piston.mass", "crank.stroke", "operation.speed"];
  const SHORT = { "layout.bank_angle": "bank angle", "rod.length": "rod", "rod.ratio": "rod / crank", "piston.mass": "piston", "crank.stroke": "stroke", "operation.speed": "speed" };
  const firstOfBook = Object.keys(book.engines)[0];
  let data, original, written, numbers, engine, ladder, ofFile, past = [], future = [];

  const { make } = Tables, { settings } = { settings: JSON.parse(byId("page").textContent) };
  const button = (text, act, id = "") => {
    const made = make("button", { type: "button", ...(id && { id }) }, text);
    made.addEventListener("click", act);
    return made;
  };
  const own = (object, key) => Object.hasOwn(object, key) ? object[key] : undefined;
  const tableOf = (name) => name.match(/^(?:counterweight|shaft|slider|cylinder)\.\d+/)?.[0] ?? name.split(".")[0];
  const shown = (value, digits = 6) => Tables.number(value, digits);
  const limits = settings.limits;

  // ------------------------------------------------------------------ numbers and their values
  // Unit and limits of a number; undefined for an unknown name.
  function find(name) {
    const [, kind, , key] = name.match(DEVICE) || [];
    return data.numbers.find((each) => each.name === name) || (key && own(own(book.devices, kind) || {}, key));
  }

  // A unit in one spelling: "kg·mm²" and "kg mm^2" are "kgmm^2", and 3.5" are in.
  function spell(unit) {
    const word = unit.normalize("NFKC").replace(/["″“”]|''/, "in").replace("°", "deg").replace("μ", "u");
    const joined = word.replace(/([a-z])(?:\*\*)?([23])/gi, "$1^$2").replace(/[\s·⋅*]+|\.$/g, "");
    return joined.length < 2 || /^M[a-zG]/.test(joined) ? joined : joined.toLowerCase();   // Mg: a megagram
  }
  // A number with the digits that a written file has.
  const brief = (value) => Number(value.toPrecision(12));
  // A number in the unit of the file, as people write it; an Error says what would be right.
  function readValue(name, text) {
    const { unit, above, least = -limits.mostOfNumbers, most = limits.mostOfNumbers, whole } = find(name), wanted = `give a number${unit ? ` in ${unit}` : ""}`;
    const plain = text.replace(/(\d?)\s*([¼-¾⅐-⅞])/, "$1 $2").normalize("NFKC").trim().replace("⁄", "/")
      .replace(/^[−–]/, "-").replace(/^(\d+)[- ](\d+\/\d+)/, "$1+$2");
    if (/^[-+]?\d{1,3},\d{3}(?!\d)/.test(plain)) throw new Error(`${name}: "${text}" can mean two numbers; write it without a comma`);
    const [, sign, figure, top, bottom, word] =
      plain.replace(",", ".").match(/^([-+]?)((?:(?!\d+\/\d)\d*\.?\d*(?:e[-+]?\d+)?)?)\+?(?:(\d+)\/(\d+))?\s*(.*)$/i) || [];
    const value = (sign === "-" ? -1 : 1) * (Number(figure || 0) + (top ? top / bottom : 0));
    if (!/\d/.test(figure + (top || "")) || !Number.isFinite(value)) {
      throw new Error(`${name}: "${text.slice(0, 40)}" is not a number; ${wanted}`);
    }
    const factors = own(book.units, unit) || {}, same = (name) => spell(name) === spell(word);
    const factor = word === "" || same(unit) ? 1 : factors[Object.keys(factors).find(same)];
    if (factor === undefined) {
      const known = Object.keys(factors).join(", ");
      throw new Error(`${name}: the unit "${word.slice(0, 20)}" is not known here; ${wanted}${known && `, or in ${known}`}`);
    }
    const found = brief(value * factor);
    if (whole && (!Number.isInteger(found) || !found)) throw new Error(`${name}: give a whole number other than 0`);
    if (above !== undefined && found <= above) throw new Error(`${name}: ${found} is not above ${above}`);
    if (least !== undefined && found < least) throw new Error(`${name}: ${found} is below ${least}`);
    if (most !== undefined && found > most) throw new Error(`${name}: ${found} is above ${most}`);
    return found;
  }

  // Ends of a slider, which contain both the file's value and the present one.
  function rangeOf(name) {
    const { unit, above, least } = find(name), value = original[name] ?? numbers[name];
    let ends = [Math.min(value / 2, 2 * value), Math.max(value / 2, 2 * value)];
    if (name === "layout.bank_angle") ends = [0, 180];
    else if (unit === "deg") ends = [0, 360];
    else if (/\.(at\.[12]|position|offset|positions\.\d+|piston_offset)$|stagger$/.test(name)) {
      const far = Math.max(2 * Math.abs(value), /offset|stagger/.test(name) ? 50 : 4 * (numbers["crank.stroke"] || 100));
      ends = [-far, far];
    } else if (!value) ends = [0, { mm: 100, kg: 5, "g mm": 100000 }[unit] || 1];
    ends = [Math.min(ends[0], numbers[name]), Math.max(ends[1], numbers[name])];
    return above !== undefined || least !== undefined ? [Math.max(ends[0], above ?? least), ends[1]] : ends;
  }

  // ------------------------------------------------------------------ state and address
  // Names and values that differ from the file; "none" for a device or key that is gone.
  function listChanges() {
    const there = new Set(Object.keys(numbers).map(tableOf));
    const gone = Object.keys(original).filter((name) => !(name in numbers)).map((name) => there.has(tableOf(name)) ? name : tableOf(name));
    const changed = Object.entries(numbers).filter(([name, value]) => value !== original[name]);
    return [...[...new Set(gone)].map((name) => [name, "none"]), ...changed.map(([name, value]) => [name, String(value)])];
  }
  function writeAddress() {
    const parts = listChanges().map(([name, value]) => `${name}=${encodeURIComponent(value)}`);
    if (data.packed) parts.unshift(`toml=${data.packed}`);
    else if (book.choice) parts.unshift(`engine=${data.key}`);
    if (step !== null) parts.push(`step=${step}`);
    return parts.length ? `#${parts.join("&")}` : "";
  }
  let step = null;                                            // that the reader chose
  const isEqual = (one, other) => Object.keys(one).length === Object.keys(other).length && Object.keys(one).every((name) => one[name] === other[name]);
  // Changes in words, "rod.length 160 → 150 mm", each with the numbers without it; then devices that the file does not have.
  function tellChanges() {
    const ofFileTables = new Set(Object.keys(original).map(tableOf)), told = [], added = {};
    const without = (name) => name in original ? { ...numbers, [name]: original[name] } : Object.fromEntries(Object.entries(numbers).filter(([key]) => key !== name));
    for (const [name, value] of listChanges()) {
      const table = tableOf(name), unit = find(name)?.unit, before = name in original ? shown(original[name]) : "none";
      const now = value === "none" ? value : [shown(Number(value)), unit].filter(Boolean).join(" ");
      if (name === table) told.push([`${table} removed`, { ...numbers, ...pick(original, table) }]);
      else if (ofFileTables.has(table)) told.push([`${name} ${before} → ${now}`, without(name)]);
      else (added[table] ??= []).push(`${name.slice(table.length + 1)} ${now}`);
    }
    const rest = (table) => Object.fromEntries(Object.entries(numbers).filter(([name]) => tableOf(name) !== table));
    return [...told, ...Object.entries(added).map(([table, keys]) => [`${table} added: ${keys.join(", ")}`, rest(table)])];
  }
  const pick = (state, table) => Object.fromEntries(Object.entries(state).filter(([name]) => tableOf(name) === table));
  function showChanges() {
    const items = tellChanges().map(([text, state]) => {
      const undo = button("×", () => apply(state, { rebuild: true }));
      undo.setAttribute("aria-label", `undo: ${text}`);
      return make("li", {}, text, undo);
    });
    const name = data.key ? `${data.key}.toml` : "the file";
    byId("changes").replaceChildren(...items.length ? items : [make("li", { className: "plain" }, "as in ", make("code", {}, name))]);
  }
  let due, spoken;
  function keepAddress() {                                    // browsers refuse more than a few changes a second
    clearTimeout(due);
    due = setTimeout(() => {
      try { history.replaceState(null, "", writeAddress() || location.pathname + location.search); } catch { /* a frame of a notebook */ }
    }, 150);
  }
  // Reads the numbers of an address; mistakes are reported, the rest applies.
  function readAddress(hash) {
    const wrong = [];
    const sets = hash.slice(1).split("&").some((part) => part.includes("=") && !/^(step|engine|toml)=/.test(part));
    let next = { ...original, ...(sets ? {} : data.start) };
    step = null;
    for (const part of hash.slice(1).split("&").filter((each) => each.includes("="))) {
      const [name, ...rest] = part.split("=");
      let text = rest.join("=");
      try { text = decodeURIComponent(text); } catch { /* as it stands */ }
      if (name === "toml" && book.choice) continue;
      if (name === "engine" && book.choice) {
        if (!own(book.engines, text)) wrong.push(`engine: there is no example ${text.slice(0, 40)}`);
        continue;
      }
      if (name === "step") {
        step = text;
        continue;
      }
      try {
        const changed = text === "none" ? without(next, name) : withValue(next, name, text);
        Kernel.assemble(data, changed);
        next = changed;
      } catch (error) { wrong.push(error.message); }
    }
    const sizes = ["unbalance", "mass", "radius"];
    for (const table of new Set(Object.keys(next).map(tableOf).filter((each) => DEVICE.test(each)))) {
      const [unbalance, mass, radius] = sizes.map((key) => `${table}.${key}` in next);
      if (unbalance || (mass && radius)) continue;
      const lack = mass ? "mass without radius" : radius ? "radius without mass" : "neither unbalance nor mass and radius";
      wrong.push(`${table}: has ${lack}; give either unbalance or mass and radius`);
      for (const key of sizes.map((each) => `${table}.${each}`)) if (key in original) next = { ...next, [key]: original[key] };
    }
    return { next, wrong };
  }
  // The state without a device, or without the mass and radius of a device that has an unbalance instead.
  function without(state, name) {
    const [, kind, , key = "mass"] = name.match(DEVICE) || [];
    if (!kind || !["mass", "radius"].includes(key)) throw new Error(`${name.slice(0, 60)}: cannot be left out`);
    const next = Object.fromEntries(Object.entries(state).filter(([key]) => key !== name && tableOf(key) !== name));
    if (Object.keys(next).length === Object.keys(state).length) throw new Error(`${name.slice(0, 60)}: is not there`);
    return next;
  }
  // The state with a new value of a number; a new device gets all its keys, and unbalance replaces mass and radius.
  function withValue(state, name, text) {
    const [, kind, , key] = name.match(DEVICE) || [];
    if (!find(name)) throw new Error(`${name.slice(0, 60)}: there is no such number to change`);
    const next = { ...state }, table = tableOf(name);
    if (kind && !Object.keys(state).some((each) => tableOf(each) === table)) {
      for (const [each, { usual }] of Object.entries(book.devices[kind])) next[`${table}.${each}`] = usual;
    }
    if (key === "unbalance") for (const each of ["mass", "radius"]) delete next[`${table}.${each}`];
    next[name] = readValue(name, text);
    return next;
  }

  // ------------------------------------------------------------------ change, undo, redo
  // Shows these numbers if they make an engine; otherwise the last valid numbers stay.
  function apply(next, { remember = true, wrong = [], rebuild = false } = {}) {
    let made, steps;
    try {
      made = Kernel.assemble(data, next);
      steps = Kernel.findLadder(made, limits);
    } catch (error) {
      complain([error.message, ...wrong]);
      return false;
    }
    const tables = (state) => [...new Set(Object.keys(state).map(tableOf))].join();
    rebuild ||= tables(next) !== tables(numbers);
    if (remember) { past.push(numbers); future = []; }
    [numbers, engine, ladder] = [next, made, steps];
    keepAddress();
    if (rebuild) buildControls();
    show(rebuild);
    complain([...wrong, ...checkStep()]);
    return true;
  }
  const change = (name, value, how) => apply({ ...numbers, [name]: value }, how);
  function travel(from, to) {
    if (!from.length) return;
    to.push(numbers);
    apply(from.pop(), { remember: false, rebuild: true });
  }
  const complain = (messages) => { byId("live-wrong").textContent = messages.join(" · "); };

  // ------------------------------------------------------------------ what the page shows
  const NOT_FOLLOWED = ["firing", "cycle", "numbering", "assumed"], REPLACED = ["cylinders", "crank", "throws", "speed", "masses", "devices"];
  function show(atOnce) {
    const differs = !isWritten(), figures = differs ? describe() : Page.ofFile, changes = listChanges();
    byId("figures").textContent = JSON.stringify(figures);
    markStale(differs);
    showChanges();
    Page.asked = step;
    Page.show(figures, { scene: makeScene(), changed: differs, compared: changes.length > 0, facts: listFacts(changes), engine: ofFile, shown: { look: data.look, file: data.key && `${data.key}.toml` }, atOnce });
    announce(figures);
    byId("undo").disabled = !past.length;
    byId("redo").disabled = !future.length;
    byId("reset").disabled = !changes.length;
    showNumbers();
  }
  // What is wrong with the step of the address, which is then left out.
  function checkStep() {
    if (step === null || Page.steps.includes(step)) return [];
    step = null;
    return [Page.tellSteps()];
  }
  const describe = () => Kernel.describe(engine, ladder, limits);
  const isWritten = () => !data.packed && (!book.choice || data.key === book.choice) && isEqual(numbers, written);
  // Facts of the head: those that the page computes, and in their places those of the file.
  function listFacts(changes) {
    const moved = changes.some(([name]) => GEOMETRY.test(name)), own = new Map(Tables.listFacts(engine, { ...data, speed: numbers["operation.speed"] }));
    return data.facts.map(([name, text]) => {
      if (own.has(name)) return [name, own.get(name)];
      return [name, text, moved && NOT_FOLLOWED.includes(name) ? "old" : ""];
    }).filter(([name]) => !REPLACED.includes(name) || own.has(name)).concat([...own].filter(([name]) => !data.facts.some(([each]) => each === name)));
  }
  // What holds only for the file is marked while numbers differ.
  function markStale(differs) {
    document.body.classList.toggle("changed", differs);
    for (const part of document.querySelectorAll("[data-of-file]")) part.classList.toggle("stale", differs);
  }
  function showNumbers() {
    for (const input of document.querySelectorAll("#live-numbers input, #main-numbers input")) {
      const value = numbers[input.name], [least, most] = rangeOf(input.name);
      if (input.type === "range") put(input, { min: least, max: most, value });
      else if (input !== document.activeElement) put(input, { value: shown(value), title: value });
      input.closest(".number").classList.toggle("differs", value !== original[input.name]);
    }
  }
  function put(input, properties) {                           // only what differs: each costs a new layout
    for (const [key, value] of Object.entries(properties)) if (input[key] !== String(value)) input[key] = value;
  }
  // Largest force and moment in a sentence that screen readers read aloud, a moment after the last change.
  function announce({ peak }) {
    const size = (kind, value) => `${kind} ${value ? Tables.sizeText(value, Tables.units[kind]) : "balanced"}`, force = size("force", peak.force_N);
    const told = data.known ? `${force}, ${size("moment", peak.moment_Nm)}.` : `${force}. ${settings.unknown}`;
    clearTimeout(spoken);
    spoken = setTimeout(() => { byId("live-largest").textContent = `Largest over a revolution: ${told}`; }, 300);
  }
  // Adds the devices of a step of the ladder to the numbers.
  function fit() {
    const next = { ...numbers }, degrees = (angle) => (angle * 180 / Math.PI % 360 + 360) % 360, chosen = ladder.steps[Page.chosen];
    step = "0";
    for (const d of chosen?.devices || []) {
      const table = freeTable(next, d.kind), start = d.kind === "counterweight" ? engine.firstAxis : 0;
      Object.assign(next, { [`${table}.unbalance`]: brief(d.U * 1e6), [`${table}.angle`]: brief(degrees(d.angle - start)), [`${table}.position`]: brief(d.z * 1e3) });
      if (d.kind === "shaft") Object.assign(next, { [`${table}.ratio`]: d.ratio, [`${table}.at.1`]: 0, [`${table}.at.2`]: 0 });
    }
    apply(next, { rebuild: true });
    byId("undo").focus();
  }
  function freeTable(state, kind) {                           // the first number after those of all devices, removed ones included
    const taken = [...Object.keys(state), ...Object.keys(original)].map((name) => name.match(DEVICE)).filter((match) => match?.[1] === kind);
    return `${kind}.${Math.max(0, ...taken.map((match) => Number(match[2]))) + 1}`;
  }

  // ------------------------------------------------------------------ pictures
  const ASSUMED_BORE = 0.95, boreOf = (made) => made.bore || ASSUMED_BORE * 2 * made.r;
  function makeScene() {
    const deg = (angle) => angle * 180 / Math.PI;
    return {
      stroke: 2e3 * engine.r, bore: 1e3 * boreOf(engine), rotary: false,
      cylinders: engine.cylinders.map((c) => ({
        number: c.number, axis: deg(c.axis) - (engine.up || 0), phase: deg(c.psi), z: 1e3 * c.z, rod: 1e3 * c.l, offset: 1e3 * c.e,
      })),
    };
  }

  // ------------------------------------------------------------------ the panel
  const IDLE = /^crosshead\./;                               // numbers that most engines leave at 0
  function buildControls() {
    const groups = new Map(), more = [];
    for (const name of Object.keys(numbers)) {
      const idle = (IDLE.test(name) && !numbers[name]) || (name === "crank.splay" && !numbers["layout.bank_angle"]);
      if (idle) more.push(name);
      else groups.set(tableOf(name), [...(groups.get(tableOf(name)) || []), name]);
    }
    const sets = [...groups].map(([table, names]) => {
      const title = TITLES[table] || table.replace(".", " ").replace(/^./, (c) => c.toUpperCase());
      const rows = names.map((name) => makeControl(name, "n", name.slice(table.length + 1)));
      if (DEVICE.test(table)) rows.push(button(`Remove ${title.toLowerCase()}`, () => removeDevice(table)));
      return make("fieldset", { className: "numbers" }, make("legend", {}, title), ...rows);
    });
    const others = more.map((name) => makeControl(name, "n", name));
    byId("live-numbers").replaceChildren(...sets, ...others.length ? [make("details", { className: "numbers" }, make("summary", {}, "more"), ...others)] : []);
    byId("main-numbers").replaceChildren(...MAIN.filter((name) => name in numbers).slice(0, 5).map((name) => makeControl(name, "m", SHORT[name])));
    byId("count").textContent = `all ${Object.keys(numbers).length} numbers`;
  }
  // A slider with a field; `place` distinguishes the two of one number.
  function makeControl(name, place, label) {
    const [least, most] = rangeOf(name), { unit, whole } = find(name);
    const slider = make("input", { type: "range", name, min: least, max: most, step: "any", value: numbers[name] });
    const field = make("input", { type: "text", name, value: shown(numbers[name]), title: String(numbers[name]), inputMode: "decimal", id: `${place}-${name}` });
    slider.setAttribute("aria-label", `${name}${unit ? `, ${unit}` : ""}`);
    let started = false;                                      // one undo for one drag
    slider.addEventListener("input", () => {
      if (change(name, Number(Number(slider.value).toPrecision(5)), { remember: !started })) started = true;
      else slider.value = numbers[name];
    });
    slider.addEventListener("change", () => { started = false; });
    field.addEventListener("change", () => {
      try { apply(withValue(numbers, name, field.value)); } catch (error) { complain([error.message]); }
      field.value = shown(numbers[name]);
    });
    const head = make("label", { htmlFor: field.id }, label.replace(/^throws\./, "throw ").replaceAll("_", " "));
    return make("div", { className: "number" }, head, field, make("span", {}, unit || ""), whole ? "" : slider);
  }
  function removeDevice(table) {
    apply(without(numbers, table), { rebuild: true });
    byId("live-add").focus();
  }
  function addDevice(kind) {
    const table = freeTable(numbers, kind);
    apply(withValue(numbers, `${table}.unbalance`, "10000"), { rebuild: true });
    byId(`n-${table}.unbalance`).focus();
  }

  // ------------------------------------------------------------------ files
  // The text of the file with the numbers of the page: a line changes its number and keeps its comment.
  function writeFile() {
    const lines = data.text.split(/\r?\n/), sections = [], lists = {}, added = [], fresh = {};
    lines.forEach((line, k) => {
      const [, open, name] = line.match(/^\s*(\[{1,2})\s*([\w.-]+)\s*\]{1,2}/) || [];
      if (name) sections.push({ name: open === "[[" ? `${name}.${lists[name] = (lists[name] || 0) + 1}` : name, from: k });
    });
    const sectionOf = (table) => {
      const at = sections.findIndex(({ name }) => name === table);
      return at < 0 ? null : { from: sections[at].from, to: sections[at + 1]?.from ?? lines.length };
    };
    const rowOf = ({ from, to }, key) => lines.findIndex((line, k) => k > from && k < to && line !== null && new RegExp(`^\\s*${key}\\s*=`).test(line));
    const put = (table, key, value) => {
      const section = sectionOf(table), row = section ? rowOf(section, key) : -1;
      if (value === "none" && row < 0) return;
      if (!section) (fresh[table] ??= []).push(`${key} = ${value}`);
      else if (row < 0) added.push({ after: section.from, text: `${key} = ${value}` });
      else if (value === "none") lines[row] = null;
      else lines[row] = lines[row].replace(/^(\s*\w+\s*=\s*)(?:"[^"]*"|'[^']*'|\[[^\]]*\]|[^\s#]+)/, (_, start) => start + value);
    };
    const changes = listChanges();
    for (const [name, value] of changes) {
      const table = tableOf(name), [key, member] = name.slice(table.length + 1).split("."), section = sectionOf(table);
      if (name === table) {                                   // a removed device
        for (let k = section.from + 1, ended = false; k < section.to; k++) {
          ended ||= /^\s*(#|$)/.test(lines[k]) && !lines.slice(k, section.to).some((line) => /^\s*\w/.test(line || ""));
          if (!ended) lines[k] = null;                        // comments before the next table stay
        }
        lines[section.from] = null;
      } else put(table, key, member ? listOf(`${table}.${key}`) : value);
    }
    if (changes.some(([name]) => GEOMETRY.test(name)) && data.frees) {
      for (const [key, value] of Object.entries(data.frees)) put("layout", key, value);
    }
    for (const { after, text } of added.sort((a, b) => b.after - a.after)) lines.splice(after + 1, 0, text);
    const blocks = Object.entries(fresh).map(([table, rows]) => {
      const head = DEVICE.test(table) ? `[[${table.split(".")[0]}]]` : `[${table}]`;
      return ["", head, ...new Set(rows)].join("\n");
    });
    const text = [...lines.filter((line) => line !== null), ...blocks].join("\n").replace(/\n*$/, "\n");
    return data.text.includes("\r\n") ? text.replaceAll("\n", "\r\n") : text;
  }
  const listOf = (path) => `[${Object.keys(numbers).filter((name) => name.startsWith(`${path}.`)).map((name) => numbers[name]).join(", ")}]`;
  // A changed engine has another name than its file, so that a command never means the unchanged one.
  function fileName() {
    const name = (data.key || data.name || "engine").replace(/[^\w-]+/g, "_").slice(0, 40) || "engine";
    return `${name}${listChanges().length ? "_changed" : ""}.toml`;
  }
  function download() {
    const link = make("a", { href: URL.createObjectURL(new Blob([writeFile()], { type: "application/toml" })), download: fileName() });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    byId("live-done").textContent = `Downloaded: ${link.download}`;
  }
  const quote = (name) => /^[\w.+-]+$/.test(name) ? name : /^[\w.+(), -]+$/.test(name) ? `"${name}"` : `'${name.replaceAll("'", "'\\''")}'`;
  function copyCommand() {
    const there = !listChanges().length && book.source;       // the file of an unchanged engine
    const hint = there ? "" : "Download TOML saves this engine under that name; do that first.";
    return copy(`balcli analyze ${quote(there || fileName())}${book.options}`, hint);
  }
  async function copy(text, hint = "") {
    try { await navigator.clipboard.writeText(text); } catch {
      const area = make("textarea", { value: text });
      document.body.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
    }
    byId("live-done").textContent = [`Copied: ${text.slice(0, 80)}`, hint].filter(Boolean).join(". ");
  }

  // ------------------------------------------------------------------ links with the whole engine
  // A link to the site has the text of the engine file in it: deflated, base64url. The last line of the text is a
  // comment with what the page needs beside the file, because only Python reads engine files.
  const FOR_THE_PAGE = "\n# for the live page: ", LONGEST = 20000, LONGEST_READ = 400000;   // bytes, letters
  const isLong = ({ text }) => new Blob([text]).size > LONGEST;
  const isAtHome = () => !book.site || location.protocol.startsWith("http");   // its own address can be sent
  async function copyLink() {
    if (isAtHome()) return copy(location.href.split("#")[0] + writeAddress());
    const { text, key, ...rest } = data;
    const whole = text.trimEnd() + FOR_THE_PAGE + JSON.stringify({ ...rest, file: key }) + "\n";
    const parts = [`toml=${await Packed.pack(whole)}`, writeAddress().slice(1)].filter(Boolean);
    return copy(`${book.site}#${parts.join("&")}`);
  }
  // Shows the engine of a link; the first engine of the page if the link is damaged.
  async function openLink(packed, hash) {
    openEngine("");
    clearTimeout(due);                                        // the address stays that of the link
    try {
      const whole = await Packed.unpack(packed, LONGEST_READ), at = whole.lastIndexOf(FOR_THE_PAGE);
      const rest = JSON.parse(whole.slice(at + FOR_THE_PAGE.length));
      const text = whole.slice(0, at + 1);
      Object.defineProperty(book.engines, LINKED, { value: { ...rest, text, packed }, configurable: true });
      openEngine(hash, LINKED);
    } catch {
      openEngine("");
      complain(["the link is incomplete"]);
    }
  }
  const LINKED = "";                                          // key of the engine of a link

  // ------------------------------------------------------------------ start
  function open(hash) {
    const packed = hash.match(/[#&]toml=([^&]*)/)?.[1];
    if (packed !== undefined && book.choice) return openLink(packed, hash);
    return openEngine(hash);
  }
  function openEngine(hash, linked = null) {
    const asked = hash.match(/[#&]engine=([^&]+)/)?.[1], keys = Object.keys(book.engines);
    const key = linked ?? (book.choice ? (keys.includes(asked) ? asked : book.choice) : firstOfBook);
    const source = book.engines[key];
    data = { ...source, key: book.choice ? source.file ?? key : book.file };
    original = Object.fromEntries(data.numbers.map(({ name, value }) => [name, value]));
    written = { ...original, ...data.start };                 // the engine of what Python wrote
    [numbers, past, future] = [original, [], []];
    const made = Kernel.assemble(data, original);
    ofFile = Kernel.describe(made, Kernel.findLadder(made, limits), limits);
    document.querySelector("h1").textContent = data.name || (book.choice ? data.key : document.querySelector("h1").textContent);
    if (book.choice) showEngines(key);
    const { next, wrong } = readAddress(hash);
    apply(next, { remember: false, wrong, rebuild: true });
  }
  // The engines to choose; that of a link stands first.
  function showEngines(key) {
    const select = byId("live-engine"), options = Object.entries(book.engines).map(([each, { name }]) => make("option", { value: each }, `${each}: ${name}`));
    if (key === LINKED) options.unshift(make("option", { value: LINKED }, `from the link: ${data.name || data.key}`));
    select.replaceChildren(...options);
    select.value = key;
  }
  function start() {
    byId("acts").prepend(
      button("Undo", () => travel(past, future), "undo"), button("Redo", () => travel(future, past), "redo"),
      button("Reset", () => { step = null; apply(original, { rebuild: true }); }, "reset"),
      ...(isAtHome() && location.protocol === "about:" ? [] : [button("Copy link", copyLink, "link")]),
      button("Download TOML", download),
    );
    byId("live-actions").append(
      button("Add a counterweight", () => addDevice("counterweight"), "live-add"), button("Add a shaft", () => addDevice("shaft")),
      button("Copy command", copyCommand),
    );
    byId("devices-fit").append(button("Fit these devices", fit, "fit"));
    document.addEventListener("step", ({ detail }) => { step = detail; keepAddress(); });
    document.addEventListener("keydown", (event) => {
      const typing = event.target.matches("input[type=text], textarea"), key = event.key.toLowerCase();
      if (typing || !(event.ctrlKey || event.metaKey) || !["z", "y"].includes(key)) return;
      event.preventDefault();
      if (key === "y" || event.shiftKey) travel(future, past);
      else travel(past, future);
    });
    if (book.choice) {
      const select = byId("live-engine");
      select.addEventListener("change", () => open(`#engine=${select.value}`));
    }
    window.addEventListener("hashchange", ({ newURL }) => {   // location may have the page's own address by now
      const hash = newURL.replace(/^[^#]*/, "");
      if (hash.includes("=")) open(hash);
    });
    const link = byId("link");
    if (link && !isAtHome() && isLong(book.engines[firstOfBook])) {
      Object.assign(link, { disabled: true, textContent: "Too long for a link: send the file", title: "The engine file is longer than 20 kB" });
    }
    window.Live = { change, apply, writeFile, writeAddress, get numbers() { return numbers; } };
    open(location.hash);
  }
  start();
})();
