"use strict";
// Numbers to drag, the state in the address, and files to take away.
(() => {
  const { make } = Tables;
  const { DEVICE, tableOf, brief } = Numbers;
  const TITLES = { crank: "Crank", rod: "Rods", piston: "Pistons", layout: "Layout", operation: "Speed" };
  const SHORT = {                                             // main numbers in their order, with short names
    "layout.bank_angle": "bank angle",
    "rod.length": "rod",
    "rod.ratio": "rod / crank",
    "piston.mass": "piston",
    "crank.stroke": "stroke",
    "operation.speed": "speed",
  };
  const MOST_MAIN = 5;
  const GEOMETRY = /^(crank\.(throws|splay)|layout\.(bank_angle|banks))|\.(bank|throw)$/;   // what a firing order depends on
  const SIZES = ["unbalance", "mass", "radius"];              // of counterweights and shafts
  const NEW_UNBALANCE = "10000";                              // g mm
  const ASSUMED_BORE = 0.95;                                  // over stroke, for drawing pistons if the file gives no bore
  const LINKED = "";                                          // key of the engine of a link

  const byId = (id) => document.getElementById(id);
  const own = (object, key) => Object.hasOwn(object, key) ? object[key] : undefined;
  const filterEntries = (object, keep) => Object.fromEntries(Object.entries(object).filter(([name]) => keep(name)));
  const toDegrees = (angle) => angle * 180 / Math.PI;
  const show6 = (value) => Tables.number(value, 6);

  const book = JSON.parse(byId("live").textContent);          // engines by key, units, new devices
  const { limits, unknown } = JSON.parse(byId("page").textContent);
  const firstOfBook = Object.keys(book.engines)[0];
  let data;                                                   // of the engine in the book
  let original;                                               // numbers of its file, by name
  let written;                                                // numbers of what Python wrote
  let numbers;                                                // present numbers
  let engine;                                                 // of the kernel
  let ladder;
  let ofFile;                                                 // figures of the file
  let step = null;                                            // name of the choice that the reader made
  let past = [];                                              // numbers before each change
  let future = [];                                            // numbers that were undone

  function makeButton(text, act, id = "") {
    const button = make("button", { type: "button", ...(id && { id }) }, text);
    button.addEventListener("click", act);
    return button;
  }
  const complain = (messages) => { byId("live-wrong").textContent = messages.join(" · "); };

  // ------------------------------------------------------------------ numbers
  // Unit and limits of a number; undefined for an unknown name.
  function findNumber(name) {
    const [, kind, , key] = name.match(DEVICE) || [];
    const ofEngine = data.numbers.find((number) => number.name === name);
    return ofEngine || (key && own(own(book.devices, kind) || {}, key));
  }

  // Ends of a slider, which contain both the file's value and the present one.
  function rangeOf(name) {
    const { above, least } = findNumber(name);
    const [start, end] = chooseRange(name, original[name] ?? numbers[name]);
    const low = Math.min(start, numbers[name]);
    const high = Math.max(end, numbers[name]);
    return [Math.max(low, above ?? least ?? -Infinity), high];
  }
  function chooseRange(name, value) {
    const { unit } = findNumber(name);
    if (name === "layout.bank_angle") return [0, 180];
    if (unit === "deg") return [0, 360];
    if (/\.(at\.[12]|position|offset|positions\.\d+|piston_offset)$|stagger$/.test(name)) {
      const usual = /offset|stagger/.test(name) ? 50 : 4 * (numbers["crank.stroke"] || 100);
      const far = Math.max(2 * Math.abs(value), usual);
      return [-far, far];
    }
    if (!value) return [0, { mm: 100, kg: 5, "g mm": 100000 }[unit] || 1];
    return [Math.min(value / 2, 2 * value), Math.max(value / 2, 2 * value)];
  }

  // The state without a device, or without the mass and radius of a device that has an unbalance instead.
  function without(state, name) {
    const [, kind, , key = "mass"] = name.match(DEVICE) || [];
    if (!kind || !["mass", "radius"].includes(key)) throw new Error(`${name.slice(0, 60)}: cannot be left out`);
    const next = filterEntries(state, (other) => other !== name && tableOf(other) !== name);
    if (Object.keys(next).length === Object.keys(state).length) throw new Error(`${name.slice(0, 60)}: is not there`);
    return next;
  }
  // The state with a new value of a number; a new device gets all its keys, and unbalance replaces mass and radius.
  function withValue(state, name, text) {
    const [, kind, , key] = name.match(DEVICE) || [];
    const number = findNumber(name);
    if (!number) throw new Error(`${name.slice(0, 60)}: there is no such number to change`);
    const table = tableOf(name);
    const next = { ...state };
    const isNewDevice = kind && !Object.keys(state).some((other) => tableOf(other) === table);
    if (isNewDevice) {
      for (const [newKey, { usual }] of Object.entries(book.devices[kind])) next[`${table}.${newKey}`] = usual;
    }
    if (key === "unbalance") {
      delete next[`${table}.mass`];
      delete next[`${table}.radius`];
    }
    next[name] = Numbers.read(name, text, number, book.units, limits);
    return next;
  }
  function isEqual(state, other) {
    const names = Object.keys(state);
    return names.length === Object.keys(other).length && names.every((name) => state[name] === other[name]);
  }
  const isWritten = () => !data.packed && (!book.choice || data.key === book.choice) && isEqual(numbers, written);
  const listTables = (state) => [...new Set(Object.keys(state).map(tableOf))];

  // ------------------------------------------------------------------ what differs from the file
  // Names and values that differ from the file; "none" for a device or key that is gone.
  function listChanges() {
    const tables = new Set(Object.keys(numbers).map(tableOf));
    const missing = Object.keys(original).filter((name) => !(name in numbers));
    const gone = new Set(missing.map((name) => tables.has(tableOf(name)) ? name : tableOf(name)));
    const differing = Object.entries(numbers).filter(([name, value]) => value !== original[name]);
    return [...[...gone].map((name) => [name, "none"]), ...differing.map(([name, value]) => [name, String(value)])];
  }

  // Changes in words, "rod.length 160 → 150 mm", each with the numbers without it; then devices that the file does not have.
  function tellChanges() {
    const tablesOfFile = new Set(listTables(original));
    const texts = [];
    const added = {};                                         // texts of keys by device
    for (const [name, value] of listChanges()) {
      const table = tableOf(name);
      if (name === table) texts.push([`${table} removed`, { ...numbers, ...filterEntries(original, (other) => tableOf(other) === table) }]);
      else if (tablesOfFile.has(table)) texts.push([`${name} ${tellBefore(name)} → ${tellValue(name, value)}`, takeBack(name)]);
      else (added[table] ??= []).push(`${name.slice(table.length + 1)} ${tellValue(name, value)}`);
    }
    for (const [table, keys] of Object.entries(added)) {
      texts.push([`${table} added: ${keys.join(", ")}`, filterEntries(numbers, (name) => tableOf(name) !== table)]);
    }
    return texts;
  }
  const tellBefore = (name) => name in original ? show6(original[name]) : "none";
  function tellValue(name, value) {
    if (value === "none") return value;
    return [show6(Number(value)), findNumber(name)?.unit].filter(Boolean).join(" ");
  }
  function takeBack(name) {
    if (name in original) return { ...numbers, [name]: original[name] };
    return filterEntries(numbers, (other) => other !== name);
  }
  function showChanges() {
    const items = tellChanges().map(([text, state]) => {
      const undo = makeButton("×", () => apply(state, { rebuild: true }));
      undo.setAttribute("aria-label", `undo: ${text}`);
      return make("li", {}, text, undo);
    });
    const file = data.key ? `${data.key}.toml` : "the file";
    const asInFile = make("li", { className: "plain" }, "as in ", make("code", {}, file));
    byId("changes").replaceChildren(...items.length ? items : [asInFile]);
  }

  // ------------------------------------------------------------------ the address
  function writeAddress() {
    const parts = listChanges().map(([name, value]) => `${name}=${encodeURIComponent(value)}`);
    if (data.packed) parts.unshift(`toml=${data.packed}`);
    else if (book.choice) parts.unshift(`engine=${data.key}`);
    if (step !== null) parts.push(`step=${step}`);
    return parts.length ? `#${parts.join("&")}` : "";
  }
  let addressDue = null;
  function keepAddress() {                                    // browsers refuse more than a few changes a second
    clearTimeout(addressDue);
    addressDue = setTimeout(() => {
      const address = writeAddress() || location.pathname + location.search;
      try { history.replaceState(null, "", address); } catch { /* a frame of a notebook */ }
    }, 150);
  }

  // Reads the numbers of an address; mistakes are reported, the rest applies.
  function readAddress(hash) {
    const assignments = listAssignments(hash);
    const setsNumbers = assignments.some(([name]) => !["step", "engine", "toml"].includes(name));
    const wrong = [];
    let next = setsNumbers ? { ...original } : { ...original, ...data.start };
    step = null;
    for (const [name, text] of assignments) {
      if (name === "step") step = text;
      else if (book.choice && name === "engine") wrong.push(...checkEngine(text));
      else if (!book.choice || name !== "toml") {
        try { next = assign(next, name, text); } catch (error) { wrong.push(error.message); }
      }
    }
    return dropSizeless(next, wrong);
  }
  // Names and texts of an address.
  function listAssignments(hash) {
    const parts = hash.slice(1).split("&").filter((part) => part.includes("="));
    return parts.map((part) => {
      const [name, ...rest] = part.split("=");
      const text = rest.join("=");
      try { return [name, decodeURIComponent(text)]; } catch { return [name, text]; }
    });
  }
  const checkEngine = (key) => own(book.engines, key) ? [] : [`engine: there is no example ${key.slice(0, 40)}`];
  function assign(state, name, text) {
    const next = text === "none" ? without(state, name) : withValue(state, name, text);
    Kernel.assemble(data, next);                              // an Error if this makes no engine
    return next;
  }
  // Devices without a size are reported, and get that of the file.
  function dropSizeless(state, wrong) {
    const next = { ...state };
    for (const table of listTables(state).filter((name) => DEVICE.test(name))) {
      const lack = findLack(state, table);
      if (!lack) continue;
      wrong.push(`${table}: has ${lack}; give either unbalance or mass and radius`);
      for (const key of SIZES.map((size) => `${table}.${size}`)) {
        if (key in original) next[key] = original[key];
      }
    }
    return { next, wrong };
  }
  function findLack(state, table) {
    const [unbalance, mass, radius] = SIZES.map((key) => `${table}.${key}` in state);
    if (unbalance || (mass && radius)) return "";
    if (mass) return "mass without radius";
    return radius ? "radius without mass" : "neither unbalance nor mass and radius";
  }

  // ------------------------------------------------------------------ change, undo, redo
  // Shows these numbers if they make an engine; otherwise the last valid numbers stay.
  function apply(next, { remember = true, wrong = [], rebuild = false } = {}) {
    let made;
    let steps;
    try {
      made = Kernel.assemble(data, next);
      steps = Kernel.findLadder(made, limits);
    } catch (error) {
      complain([error.message, ...wrong]);
      return false;
    }
    const hasOtherTables = String(listTables(next)) !== String(listTables(numbers));
    const isNew = rebuild || hasOtherTables;
    if (remember) {
      past.push(numbers);
      future = [];
    }
    numbers = next;
    engine = made;
    ladder = steps;
    keepAddress();
    if (isNew) buildControls();
    show(isNew);
    complain([...wrong, ...checkStep()]);
    return true;
  }
  const change = (name, value, how) => apply({ ...numbers, [name]: value }, how);
  function travel(from, to) {
    if (!from.length) return;
    to.push(numbers);
    apply(from.pop(), { remember: false, rebuild: true });
  }
  const undo = () => travel(past, future);
  const redo = () => travel(future, past);
  function reset() {
    step = null;
    apply(original, { rebuild: true });
  }
  // What is wrong with the step of the address, which is then left out.
  function checkStep() {
    if (step === null || Page.steps.includes(step)) return [];
    step = null;
    return [Page.tellSteps()];
  }

  // ------------------------------------------------------------------ what the page shows
  function show(atOnce) {
    const changed = !isWritten();
    const changes = listChanges();
    const figures = changed ? Kernel.describe(engine, ladder, limits) : Page.ofFile;
    byId("figures").textContent = JSON.stringify(figures);
    markStale(changed);
    showChanges();
    Page.asked = step;
    Page.show(figures, {
      scene: makeScene(),
      changed,
      compared: changes.length > 0,
      facts: listFacts(changes),
      engine: ofFile,
      shown: { look: data.look, file: data.key && `${data.key}.toml` },
      atOnce,
    });
    announce(figures);
    byId("undo").disabled = !past.length;
    byId("redo").disabled = !future.length;
    byId("reset").disabled = !changes.length;
    showNumbers();
  }

  // Facts of the head: those that the page computes, and in their places those of the file.
  const COMPUTED = ["cylinders", "crank", "throws", "speed", "masses", "devices"];
  const NOT_FOLLOWED = ["firing", "cycle", "numbering", "assumed"];
  function listFacts(changes) {
    const computed = new Map(Tables.listFacts(engine, { ...data, speed: numbers["operation.speed"] }));
    const isMoved = changes.some(([name]) => GEOMETRY.test(name));
    const stillThere = data.facts.filter(([name]) => computed.has(name) || !COMPUTED.includes(name));
    const facts = stillThere.map(([name, text]) => {
      if (computed.has(name)) return [name, computed.get(name)];
      return [name, text, isMoved && NOT_FOLLOWED.includes(name) ? "old stale" : ""];
    });
    const added = [...computed].filter(([name]) => !data.facts.some(([other]) => other === name));
    return [...facts, ...added];
  }
  // What holds only for the file is marked while numbers differ.
  function markStale(changed) {
    document.body.classList.toggle("changed", changed);
    for (const part of document.querySelectorAll("[data-of-file]")) part.classList.toggle("stale", changed);
  }
  function showNumbers() {
    for (const input of document.querySelectorAll("#live-numbers input, #main-numbers input")) {
      const value = numbers[input.name];
      if (input.type === "range") {
        const [min, max] = rangeOf(input.name);
        setIfOther(input, { min, max, value });
      } else if (input !== document.activeElement) {
        setIfOther(input, { value: show6(value), title: value });
      }
      input.closest(".number").classList.toggle("differs", value !== original[input.name]);
    }
  }
  function setIfOther(input, properties) {                    // each property that is set costs a new layout
    for (const [key, value] of Object.entries(properties)) {
      if (input[key] !== String(value)) input[key] = value;
    }
  }
  // Largest force and moment in a sentence that screen readers read aloud, a moment after the last change.
  let speechDue = null;
  function announce({ peak }) {
    const tell = (kind, value) => `${kind} ${value ? Tables.sizeText(value, Tables.units[kind]) : "balanced"}`;
    const force = tell("force", peak.force_N);
    const both = data.known ? `${force}, ${tell("moment", peak.moment_Nm)}.` : `${force}. ${unknown}`;
    clearTimeout(speechDue);
    speechDue = setTimeout(() => { byId("live-largest").textContent = `Largest over a revolution: ${both}`; }, 300);
  }
  function makeScene() {
    const bore = engine.bore || ASSUMED_BORE * 2 * engine.r;
    return {
      stroke: 2e3 * engine.r,
      bore: 1e3 * bore,
      rotary: false,
      cylinders: engine.cylinders.map(({ number, axis, psi, z, l, e }) => ({
        number,
        axis: toDegrees(axis) - (engine.up || 0),
        phase: toDegrees(psi),
        z: 1e3 * z,
        rod: 1e3 * l,
        offset: 1e3 * e,
      })),
    };
  }

  // ------------------------------------------------------------------ controls
  function buildControls() {
    const names = Object.keys(numbers);
    const isIdle = (name) => (/^crosshead\./.test(name) && !numbers[name]) || (name === "crank.splay" && !numbers["layout.bank_angle"]);
    const groups = new Map();
    for (const name of names.filter((other) => !isIdle(other))) {
      groups.set(tableOf(name), [...(groups.get(tableOf(name)) || []), name]);
    }
    const sets = [...groups].map(([table, ofTable]) => makeGroup(table, ofTable));
    const idle = names.filter(isIdle).map((name) => makeControl(name, "n", name));
    if (idle.length) sets.push(make("details", { className: "numbers" }, make("summary", {}, "more"), ...idle));
    byId("live-numbers").replaceChildren(...sets);
    const main = Object.keys(SHORT).filter((name) => name in numbers).slice(0, MOST_MAIN);
    byId("main-numbers").replaceChildren(...main.map((name) => makeControl(name, "m", SHORT[name])));
    byId("count").textContent = `all ${names.length} numbers`;
  }
  function makeGroup(table, names) {
    const title = TITLES[table] || table.replace(".", " ").replace(/^./, (letter) => letter.toUpperCase());
    const rows = names.map((name) => makeControl(name, "n", name.slice(table.length + 1)));
    if (DEVICE.test(table)) rows.push(makeButton(`Remove ${title.toLowerCase()}`, () => removeDevice(table)));
    return make("fieldset", { className: "numbers" }, make("legend", {}, title), ...rows);
  }
  // A slider with a field; `place` distinguishes the two of one number.
  function makeControl(name, place, label) {
    const { unit, whole } = findNumber(name);
    const field = makeField(name, `${place}-${name}`);
    const text = label.replace(/^throws\./, "throw ").replaceAll("_", " ");
    const head = make("label", { htmlFor: field.id }, text);
    const slider = whole ? "" : makeSlider(name, unit);
    return make("div", { className: "number" }, head, field, make("span", {}, unit || ""), slider);
  }
  function makeField(name, id) {
    const field = make("input", { type: "text", name, id, value: show6(numbers[name]), title: String(numbers[name]), inputMode: "decimal" });
    field.addEventListener("change", () => {
      try { apply(withValue(numbers, name, field.value)); } catch (error) { complain([error.message]); }
      field.value = show6(numbers[name]);
    });
    return field;
  }
  function makeSlider(name, unit) {
    const [min, max] = rangeOf(name);
    const slider = make("input", { type: "range", name, min, max, step: "any", value: numbers[name] });
    slider.setAttribute("aria-label", unit ? `${name}, ${unit}` : name);
    let isDragged = false;                                    // one undo for one drag
    slider.addEventListener("input", () => {
      const value = Number(Number(slider.value).toPrecision(5));
      if (change(name, value, { remember: !isDragged })) isDragged = true;
      else slider.value = numbers[name];
    });
    slider.addEventListener("change", () => { isDragged = false; });
    return slider;
  }

  // ------------------------------------------------------------------ devices
  function removeDevice(table) {
    apply(without(numbers, table), { rebuild: true });
    byId("live-add").focus();
  }
  function addDevice(kind) {
    const table = nameNew(numbers, kind);
    apply(withValue(numbers, `${table}.unbalance`, NEW_UNBALANCE), { rebuild: true });
    byId(`n-${table}.unbalance`).focus();
  }
  // Adds the devices of the choice to the numbers.
  function fit() {
    const next = { ...numbers };
    for (const device of Page.devices) Object.assign(next, listKeys(nameNew(next, device.kind), device));
    step = "0";
    apply(next, { rebuild: true });
    byId("undo").focus();
  }
  function listKeys(table, { kind, unbalance_kg_m, angle_deg, position_mm, ratio, at_mm }) {
    const keys = {
      [`${table}.unbalance`]: brief(unbalance_kg_m * 1e6),
      [`${table}.angle`]: brief((angle_deg % 360 + 360) % 360),
      [`${table}.position`]: brief(position_mm),
    };
    if (kind !== "shaft") return keys;
    return { ...keys, [`${table}.ratio`]: ratio, [`${table}.at.1`]: brief(at_mm[0]), [`${table}.at.2`]: brief(at_mm[1]) };
  }
  // The first name after those of all devices of a kind, removed ones included.
  function nameNew(state, kind) {
    const matches = [...Object.keys(state), ...Object.keys(original)].map((name) => name.match(DEVICE));
    const taken = matches.filter((match) => match?.[1] === kind).map(([, , number]) => Number(number));
    return `${kind}.${Math.max(0, ...taken) + 1}`;
  }

  // ------------------------------------------------------------------ files and commands
  function writeFile() {
    const changes = listChanges();
    const isMoved = changes.some(([name]) => GEOMETRY.test(name));
    return EngineText.write(data.text, numbers, changes, Object.entries(isMoved && data.frees || {}));
  }
  // A changed engine has another name than its file, so that a command never means the unchanged one.
  function nameFile() {
    const name = (data.key || data.name || "engine").replace(/[^\w-]+/g, "_").slice(0, 40) || "engine";
    return `${name}${listChanges().length ? "_changed" : ""}.toml`;
  }
  const tellDone = (text) => { byId("live-done").textContent = text; };
  function download() {
    const blob = new Blob([writeFile()], { type: "application/toml" });
    const link = make("a", { href: URL.createObjectURL(blob), download: nameFile() });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    tellDone(`Downloaded: ${link.download}`);
  }
  // A name as shells read it.
  function quote(name) {
    if (/^[\w.+-]+$/.test(name)) return name;
    return /^[\w.+(), -]+$/.test(name) ? `"${name}"` : `'${name.replaceAll("'", "'\\''")}'`;
  }
  function copyCommand() {
    const source = listChanges().length ? "" : book.source;   // the file of an unchanged engine
    const hint = source ? "" : "Download TOML saves this engine under that name; do that first.";
    return copy(`balcli analyze ${quote(source || nameFile())}${book.options}`, hint);
  }
  async function copy(text, hint = "") {
    try { await navigator.clipboard.writeText(text); } catch { copyBySelection(text); }
    tellDone([`Copied: ${text.slice(0, 80)}`, hint].filter(Boolean).join(". "));
  }
  function copyBySelection(text) {
    const area = make("textarea", { value: text });
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }

  // ------------------------------------------------------------------ links with the whole engine
  // A link to the site has the text of the engine file in it: deflated, base64url. The last line of the text is a
  // comment with what the page needs beside the file, because only Python reads engine files.
  const FOR_THE_PAGE = "\n# for the live page: ";
  const LONGEST = 20000;                                      // bytes of a file
  const LONGEST_READ = 400000;                                // letters of a link's text
  const isLong = ({ text }) => new Blob([text]).size > LONGEST;
  const isAtHome = () => !book.site || location.protocol.startsWith("http");   // its own address can be sent
  async function copyLink() {
    if (isAtHome()) return copy(location.href.split("#")[0] + writeAddress());
    const { text, key, ...rest } = data;
    const whole = `${text.trimEnd()}${FOR_THE_PAGE}${JSON.stringify({ ...rest, file: key })}\n`;
    const parts = [`toml=${await Packed.pack(whole)}`, writeAddress().slice(1)].filter(Boolean);
    return copy(`${book.site}#${parts.join("&")}`);
  }
  // Shows the engine of a link; the first engine of the page if the link is damaged.
  async function openLink(packed, hash) {
    openEngine("");
    clearTimeout(addressDue);                                 // the address stays that of the link
    try {
      const value = { ...readLink(await Packed.unpack(packed, LONGEST_READ)), packed };
      Object.defineProperty(book.engines, LINKED, { value, configurable: true });
      openEngine(hash, LINKED);
    } catch {
      openEngine("");
      complain(["the link is incomplete"]);
    }
  }
  function readLink(whole) {
    const end = whole.lastIndexOf(FOR_THE_PAGE);
    const rest = JSON.parse(whole.slice(end + FOR_THE_PAGE.length));
    return { ...rest, text: whole.slice(0, end + 1) };
  }

  // ------------------------------------------------------------------ open
  function open(hash) {
    const packed = hash.match(/[#&]toml=([^&]*)/)?.[1];
    if (packed !== undefined && book.choice) return openLink(packed, hash);
    return openEngine(hash);
  }
  function openEngine(hash, linked = null) {
    const key = linked ?? chooseEngine(hash);
    const source = book.engines[key];
    data = { ...source, key: book.choice ? source.file ?? key : book.file };
    original = Object.fromEntries(data.numbers.map(({ name, value }) => [name, value]));
    written = { ...original, ...data.start };
    numbers = original;
    past = [];
    future = [];
    const made = Kernel.assemble(data, original);
    ofFile = Kernel.describe(made, Kernel.findLadder(made, limits), limits);
    showTitle();
    if (book.choice) showEngines(key);
    const { next, wrong } = readAddress(hash);
    apply(next, { remember: false, wrong, rebuild: true });
  }
  function chooseEngine(hash) {
    if (!book.choice) return firstOfBook;
    const wanted = hash.match(/[#&]engine=([^&]+)/)?.[1];
    return Object.keys(book.engines).includes(wanted) ? wanted : book.choice;
  }
  function showTitle() {
    const title = data.name || (book.choice && data.key);
    if (title) document.querySelector("h1").textContent = title;
  }
  // The engines to choose; that of a link stands first.
  function showEngines(key) {
    const select = byId("live-engine");
    const options = Object.entries(book.engines).map(([value, { name }]) => make("option", { value }, `${value}: ${name}`));
    if (key === LINKED) options.unshift(make("option", { value: LINKED }, `from the link: ${data.name || data.key}`));
    select.replaceChildren(...options);
    select.value = key;
  }

  // ------------------------------------------------------------------ start
  function addButtons() {
    const isInFrame = isAtHome() && location.protocol === "about:";   // of a notebook: it has no address to send
    byId("acts").prepend(
      makeButton("Undo", undo, "undo"),
      makeButton("Redo", redo, "redo"),
      makeButton("Reset", reset, "reset"),
      ...isInFrame ? [] : [makeButton("Copy link", copyLink, "link")],
      makeButton("Download TOML", download),
    );
    byId("live-actions").append(
      makeButton("Add a counterweight", () => addDevice("counterweight"), "live-add"),
      makeButton("Add a shaft", () => addDevice("shaft")),
      makeButton("Copy command", copyCommand),
    );
    byId("devices-fit").append(makeButton("Fit these devices", fit, "fit"));
  }
  function refuseLongLink() {
    const link = byId("link");
    if (!link || isAtHome() || !isLong(book.engines[firstOfBook])) return;
    link.disabled = true;
    link.textContent = "Too long for a link: send the file";
    link.title = "The engine file is longer than 20 kB";
  }
  function followKey(event) {
    const key = event.key.toLowerCase();
    const isTyping = event.target.matches("input[type=text], textarea");
    if (isTyping || !(event.ctrlKey || event.metaKey) || !["z", "y"].includes(key)) return;
    event.preventDefault();
    if (key === "y" || event.shiftKey) redo();
    else undo();
  }
  function followHash({ newURL }) {                           // location may have the page's own address by now
    const hash = newURL.replace(/^[^#]*/, "");
    if (hash.includes("=")) open(hash);
  }
  function followStep({ detail }) {
    step = detail;
    keepAddress();
  }
  function start() {
    addButtons();
    refuseLongLink();
    document.addEventListener("step", followStep);
    document.addEventListener("keydown", followKey);
    window.addEventListener("hashchange", followHash);
    byId("live-engine")?.addEventListener("change", ({ target }) => open(`#engine=${target.value}`));
    window.Live = { change, apply, writeFile, writeAddress, get numbers() { return numbers; } };
    open(location.hash);
  }
  start();
})();
