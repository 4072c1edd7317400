"use strict";
// Free forces and moments of an engine: exact motions at even crank angles, summed, and a Fourier
// transform. This calculation shares no code with the Python program. Vectors in the plane are
// [x, y]; SI units and radians unless a name says mm or deg.
const Kernel = (() => {
  const TURN = 2 * Math.PI, SAMPLES = 256, ORDERS = 12, ROUNDING = 4e-15, NONE = [[0, 0], [0, 0]];
  const LONG_STROKE = 1, LONG_STROKE_IN_BORES = 2.5;          // m, and in bores: only crosshead engines have longer strokes
  const UPRIGHT = { force: ["vertical", "horizontal"], moment: ["yawing", "pitching"] };
  const rad = (deg) => deg * TURN / 360, deg = (angle) => angle * 360 / TURN;
  const polar = (size, angle) => [size * Math.cos(angle), size * Math.sin(angle)];
  const add = (a, b) => [a[0] + b[0], a[1] + b[1]];
  const times = (a, b) => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
  const scaled = (a, factor) => [a[0] * factor, a[1] * factor];
  const cross = (a, b) => a[0] * b[1] - a[1] * b[0];
  const size = (a) => Math.hypot(a[0], a[1]);
  const sum = (values) => values.reduce((a, b) => a + b, 0);

  // ------------------------------------------------------------------ numbers -> engine
  // Masses at the ends of a rod (kg), and H, by which their moment of inertia exceeds the rod's.
  function weighRod(rod, take, l) {
    let small = rod.small_end ? take(rod.small_end) : 0, big = rod.big_end ? take(rod.big_end) : 0;
    if (!rod.small_end && !rod.big_end && rod.mass) {
      const share = (rod.cg ? take(rod.cg) : 0) / 1e3 / l;
      [small, big] = [take(rod.mass) * share, take(rod.mass) * (1 - share)];
    }
    const mass = small + big, share = mass ? small / mass : 0, points = mass * share * (1 - share) * l * l;
    let spin = points;
    if (rod.inertia) spin = take(rod.inertia) / 1e6;
    else if (rod.period) {
      const arm = l * (rod.pivot === "big_end" ? share : 1 - share);
      spin = mass * arm * (9.80665 * (rod.period / TURN) ** 2 - arm);
    }
    const H = points - spin;
    return { small, big, H: Math.abs(H) > 1.8e-15 * (points + Math.abs(spin)) ? H : 0, bad: spin < 0 };
  }

  // The engine of the page's data with these numbers (by dotted name); an Error states what is wrong.
  function assemble(data, numbers) {
    const take = (name) => numbers[name] ?? 0;
    const form = ({ value, by }) => value + sum(Object.entries(by).map(([name, factor]) => factor * take(name)));
    const r = take("crank.stroke") / 2e3, omega = take("operation.speed") * TURN / 60;
    const cylinders = data.cylinders.map((c) => {
      const l = c.rod.length ? take(c.rod.length) / 1e3 : r / take(c.rod.ratio), e = take(c.offset) / 1e3;
      const rod = weighRod(c.rod, take, l), name = c.rod.length || c.rod.ratio;
      if (!(r / l + Math.abs(e) / l < 1)) {
        throw new Error(`${name}: the crank cannot turn: lambda = ${(r / l).toPrecision(4)} and offset over `
          + `length = ${(Math.abs(e) / l).toPrecision(4)} must stay below 1 together; make the rod longer`);
      }
      const piston = sum(c.piston.map(take)), throwMass = c.share * take("crank.throw_mass");
      if (rod.bad) throw new Error(`${c.rod.cg || "rod"}: is outside the rod, so two masses at its ends cannot replace the rod`);
      return {
        number: c.number, axis: rad(form(c.axis)), lead: rad(form(c.lead)), by: c.by, z: form(c.z) / 1e3, r, l, e,
        reciprocating: piston + rod.small, rotating: throwMass + rod.big + c.extra, H: rod.H,
      };
    });
    const of = (number) => cylinders.find((c) => c.number === number), first = of(1);
    const top = (number) => number === null ? 0 : Math.asin(of(number).e / (of(number).r + of(number).l));
    for (const c of cylinders) c.psi = first.axis + c.lead + top(c.by) - top(first.by) - c.axis;
    const throws = data.throws.map((each) => form(each) / 1e3);
    const middle = (Math.min(...throws) + Math.max(...throws)) / 2;
    const reference = data.reference ? data.reference.map((v) => v / 1e3) : [0, 0, middle];
    const bore = take("piston.bore") / 1e3, long = 2 * r > LONG_STROKE || (bore && 2 * r > LONG_STROKE_IN_BORES * bore);
    const crossheads = data.strokes === 2 && (long || data.cylinders.some((c) => take(c.crosshead) > 0));
    return {
      omega, r, cylinders, throws, reference, devices: listDevices(numbers, first.axis), firstAxis: first.axis,
      known: data.known, up: data.up, gasOrders: data.gasOrders, bore, crossheads,
    };
  }

  // Counterweights, shafts and sliders among the numbers, as vectors of mass x radius (kg m).
  function listDevices(numbers, firstAxis) {
    const tables = {};
    for (const [name, value] of Object.entries(numbers)) {
      const [, table, key] = name.match(/^((?:counterweight|shaft|slider)\.\d+)\.(.+)$/) || [];
      if (table) (tables[table] ??= {})[key] = value;
    }
    return Object.entries(tables).map(([table, t]) => {
      const kind = table.split(".")[0], get = (key) => t[key] ?? 0;
      const U = t.unbalance === undefined ? get("mass") * get("radius") / 1e3 : t.unbalance / 1e6;
      return makeDevice(kind, U, rad(get("angle")) + (kind === "counterweight" ? firstAxis : 0), get("position") / 1e3,
        get("ratio") || get("order") || 1, [get("at.1") / 1e3, get("at.2") / 1e3], rad(get("direction")));
    });
  }

  function makeDevice(kind, U, angle, z, ratio = 1, at = [0, 0], direction = 0) {
    const turning = polar(U, angle), none = [0, 0], order = Math.abs(ratio), one = { kind, U, angle, z, ratio, order, at };
    if (kind === "slider") {
      const half = polar(0.5, direction);
      return { ...one, forward: times(half, turning), backward: times(half, [turning[0], -turning[1]]) };
    }
    return ratio > 0 ? { ...one, forward: turning, backward: none } : { ...one, forward: none, backward: turning };
  }

  // ------------------------------------------------------------------ one crank angle
  // Force and moment [x, y], couple and inertia torque of the cylinders at a crank angle.
  function load(engine, theta) {
    const square = engine.omega ** 2, sums = { force: [0, 0], moment: [0, 0], couple: 0, torque: 0 };
    for (const c of engine.cylinders) {
      const psi = theta + c.psi, lam = c.r / c.l, sine = lam * Math.sin(psi) - c.e / c.l;
      const cosine = Math.sqrt((1 - sine) * (1 + sine)), beta1 = lam * Math.cos(psi) / cosine;
      const beta2 = (sine * beta1 ** 2 - lam * Math.sin(psi)) / cosine;
      const s1 = -c.r * Math.sin(psi) - c.l * sine * beta1;
      const s2 = -c.r * Math.cos(psi) - c.l * (cosine * beta1 ** 2 + sine * beta2);
      const along = -c.reciprocating * s2 + c.rotating * c.r * Math.cos(psi);
      const f = scaled(times([along, c.rotating * c.r * Math.sin(psi)], polar(1, c.axis)), square);
      sums.force = add(sums.force, f);
      sums.moment = add(sums.moment, momentOf(engine, f, c.z));
      sums.couple += square * (-c.H * beta2 + c.reciprocating * c.e * s2) + cross(armOf(engine, [0, 0]), f);
      sums.torque -= square * (c.reciprocating * s1 * s2 - c.H * beta1 * beta2);
    }
    return sums;
  }
  const armOf = (engine, [x, y]) => [x - engine.reference[0], y - engine.reference[1]];
  const momentOf = (engine, f, z) => [-(z - engine.reference[2]) * f[1], (z - engine.reference[2]) * f[0]];

  // ------------------------------------------------------------------ orders
  // Forward and backward phasors of orders 0 to `most` of values [x, y] at even angles.
  function transform(values, most) {
    const found = [], count = values.length;
    const turns = values.map((_, k) => polar(1 / count, TURN * k / count));
    for (let n = 0; n <= most; n++) {
      let ax = 0, ay = 0, bx = 0, by = 0;
      for (let k = 0; k < count; k++) {
        const [x, y] = values[k], [c, s] = turns[n * k % count];
        ax += x * c + y * s; ay += y * c - x * s;
        bx += x * c - y * s; by += y * c + x * s;
      }
      found.push(n ? [[ax, ay], [bx, by]] : [[ax, ay], [0, 0]]);
    }
    return found;
  }

  // Largest force, moment and moment about the crank if nothing cancelled; rounding errors are compared with these.
  function bound(engine) {
    const square = engine.omega ** 2, arm = (z) => Math.abs(z) + Math.abs(engine.reference[2]);
    const pulls = engine.cylinders.map((c) => (2 * c.reciprocating + c.rotating) * c.r * square);
    const own = engine.cylinders.map((c, k) => pulls[k] * (c.r + Math.abs(c.e)) + Math.abs(c.H) * square);
    return {
      force: sum(pulls), moment: sum(engine.cylinders.map((c, k) => pulls[k] * arm(c.z))),
      about: sum(own) + sum(pulls) * size(armOf(engine, [0, 0])),
    };
  }

  // Phasors by kind and order, and peaks; cylinders are sampled, devices are computed in closed form.
  function compute(engine) {
    const loads = Array.from({ length: SAMPLES }, (_, k) => load(engine, TURN * k / SAMPLES)), most = bound(engine);
    const series = (pick, limit) => transform(loads.map(pick), SAMPLES / 2 - 1).map((pair) =>
      pair.map((v) => size(v) <= ROUNDING * limit ? [0, 0] : v));
    return addDevices(engine, {
      force: series((v) => v.force, most.force), moment: series((v) => v.moment, most.moment),
      couple: series((v) => [v.couple, 0], most.about), torque: series((v) => [v.torque, 0], most.about),
      roll: series((v) => [v.couple - v.torque, 0], most.about),
    }, engine.devices);
  }

  // Phasors and peaks with devices: each device adds to one order.
  function addDevices(engine, kinds, devices) {
    const sums = Object.fromEntries(Object.entries(kinds).map(([kind, pairs]) => [kind, pairs.slice()]));
    const drop = (v, part) => size(v) <= 1e-13 * size(part) ? [0, 0] : v;
    const put = (kind, n, parts) => {
      const before = sums[kind][n] || NONE;
      sums[kind][n] = parts.map((v, k) => drop(add(before[k], v), v));
    };
    for (const d of devices) {
      const pair = [d.forward, d.backward].map((v) => scaled(v, (d.order * engine.omega) ** 2));
      put("force", d.order, pair);
      put("moment", d.order, pair.map((v) => momentOf(engine, v, d.z)));
      const arm = armOf(engine, d.at), [[ax, ay], [bx, by]] = pair;                // Im(conj(arm) F), F = a e + b/e
      const turned = [arm[0] * (ay + by) - arm[1] * (ax + bx), -arm[0] * (ax - bx) - arm[1] * (ay - by)];
      const half = scaled(turned, 0.5);
      for (const kind of ["couple", "roll"]) put(kind, d.order, [half, [half[0], -half[1]]]);
    }
    return { kinds: sums, peak: { force: findPeak(sums.force), moment: findPeak(sums.moment) } };
  }

  // The largest size of a vector over a revolution, by Newton's method from the highest of even angles.
  function findPeak(phasors) {
    const total = sum(phasors.map(([a, b]) => size(a) + size(b)));
    const orders = [];
    phasors.forEach(([a, b], n) => { if (size(a) + size(b) > 1e-14 * total) orders.push({ n, a, b }); });
    if (!orders.length) return { value: 0, theta: null };
    const value = (theta, power) => {                         // the vector, or its first or second derivative
      let x = 0, y = 0;
      for (const { n, a, b } of orders) {
        const c = Math.cos(n * theta), s = Math.sin(n * theta), [p, q] = [n ** power, (-n) ** power];
        x += p * (a[0] * c - a[1] * s) + q * (b[0] * c + b[1] * s);
        y += p * (a[0] * s + a[1] * c) + q * (b[1] * c - b[0] * s);
      }
      return power === 0 ? [x, y] : power === 1 ? [-y, x] : [-x, -y];
    };
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1], count = 16 * Math.max(16, orders.at(-1).n), step = TURN / count;
    const sizes = Array.from({ length: count }, (_, k) => size(value(step * k, 0))), most = Math.max(...sizes);
    const tops = [];
    sizes.forEach((v, k) => {
      const here = v >= sizes.at(k - 1) && v >= sizes[(k + 1) % count] && v >= 0.98 * most;
      if (!here && !(k === 0 && v >= most * (1 - 1e-12))) return;
      let theta = step * k;
      for (let round = 0; round < 8; round++) {
        const [p, d1, d2] = [0, 1, 2].map((power) => value(theta, power)), curvature = dot(d1, d1) + dot(p, d2);
        if (curvature < 0) theta -= Math.max(-step, Math.min(step, dot(p, d1) / curvature));
      }
      const at = ((theta % TURN) + TURN) % TURN;
      tops.push({ value: size(value(theta, 0)), theta: TURN - at < 1e-7 ? 0 : at });
    });
    const top = Math.max(...tops.map((each) => each.value));
    return tops.filter((each) => each.value >= top * (1 - 1e-9)).sort((a, b) => a.theta - b.theta)[0];
  }

  // ------------------------------------------------------------------ the ladder
  // A part is small if it is 0 or below a limit; a part of just this size is not small.
  const isSmall = (value, least) => !value || value < least * (1 - 1e-9);

  // Devices that balance the engine step by step, without counterweights at every throw, which only relieve bearings.
  // `limits` are those of the command: small, shown, rounding.
  function findLadder(engine, limits) {
    const square = engine.omega ** 2, z = engine.cylinders.map((c) => c.z);
    const F = Math.max(...engine.cylinders.map((c) => c.reciprocating * c.r)) * square;
    const M = F * Math.max(Math.max(...z) - Math.min(...z), 2 * engine.r);
    const drawn = compute(engine), steps = [{ step: "as drawn", devices: [], ...drawn }];
    const part = (kinds, order, sense) => ["force", "moment"].map((kind) => {
      const v = kinds[kind][order][sense > 0 ? 0 : 1];
      return kind === "force" ? v : engine.known ? [v[1], -v[0]] : [0, 0];      // the moment is i z F
    });
    const share = ([f, m]) => F ? Math.max(size(f) / F, size(m) / M) : 0;
    const isLarge = (value) => !isSmall(value, limits.small);
    const list = (step, devices) => {
      const all = [...steps.at(-1).devices, ...devices];
      steps.push({ step, devices: all, ...addDevices(engine, drawn.kinds, all) });
    };
    // A step with a device for each of these directions in which a large part turns.
    const offer = (order, senses, name) => {
      const due = senses.map((sense) => ({ order, sense, part: part(drawn.kinds, order, sense) }));
      const large = due.filter((each) => isLarge(share(each.part)));
      if (large.length) list(name(large.map(({ sense }) => sense)), large.flatMap((each) => cancel(engine, each, M / F, limits)));
    };
    // A step with pairs of masses at both ends, for the moment about y that the rows before leave.
    const offerCompensators = (order) => {
      const [[, ahead], [, against]] = [1, -1].map((sense) => part(steps.at(-1).kinds, order, sense));
      const moment = add(ahead, [against[0], -against[1]]);
      if (size(moment) > limits.rounding * M && isLarge(size(moment) / M)) list(`compensators of order ${order}`, compensate(engine, order, moment));
    };
    offer(1, [1], () => "counterweights");
    if (engine.crossheads) {
      if (engine.known) [1, 2].forEach(offerCompensators);
    } else {
      offer(1, [-1], () => "shaft at -1");
      offer(2, [1, -1], (senses) => senses.length > 1 ? "shafts at +2 and -2" : `shaft at ${senses[0] > 0 ? "+2" : "-2"}`);
    }
    return { steps, scale: { force: F, moment: M } };
  }

  // The end planes: the first and the last throw; for throws in one plane, half a bore on either side of it.
  function findEnds(engine) {
    const [low, high] = [Math.min(...engine.throws), Math.max(...engine.throws)], half = engine.bore / 2 || engine.r;
    return low === high ? [low - half, high + half] : [low, high];
  }

  // Pairs of equal masses in the end planes that turn in opposite directions: their forces along x cancel a moment about y.
  function compensate(engine, order, moment) {
    const [low, high] = findEnds(engine), force = scaled(moment, 1 / (high - low) / (order * engine.omega) ** 2);
    const half = size(force) / 2, angle = Math.atan2(force[1], force[0]);
    return [[low, angle], [high, angle + TURN / 2]].flatMap(([z, at]) =>
      [1, -1].map((sense) => makeDevice("shaft", half, sense * at, z, sense * order)));
  }

  // Devices that cancel a rotating force and moment: a single device if it suffices, otherwise two at the ends.
  function cancel(engine, { order, sense, part: [f, m] }, length, limits) {
    const kind = order * sense === 1 ? "counterweight" : "shaft", per = -1 / (order * engine.omega) ** 2;
    const [low, high] = findEnds(engine);
    const reach = [...engine.throws, ...engine.cylinders.map((c) => c.z)], zr = engine.reference[2];
    const make = ([x, y], z) => makeDevice(kind, Math.hypot(x, y), Math.atan2(y, x), z, sense * order);
    if (kind === "shaft" && size(f)) {
      const at = zr + (m[0] * f[0] + m[1] * f[1]) / size(f) ** 2;
      const z = Math.min(Math.max(at, Math.min(...reach)), Math.max(...reach));
      if (size(add(m, scaled(f, zr - z))) <= 1e-11 * (size(m) + size(f) * length)) return [make(scaled(f, per), z)];
    }
    const upper = scaled(add(m, scaled(f, zr - low)), per / (high - low)), lower = add(scaled(f, per), scaled(upper, -1));
    const most = sum(engine.cylinders.map((c) => (c.reciprocating + c.rotating) * c.r));
    const least = kind === "shaft" ? 0 : limits.rounding * most;
    return [[lower, low], [upper, high]].filter(([v]) => size(v) > least).map((each) => make(...each));
  }

  // ------------------------------------------------------------------ the verdict
  // Orders that the command shows: 1, 2, those of gas, and those in which some kind exceeds a share of its largest amplitude.
  function listShown(engine, { steps: [{ kinds }] }, { shown }) {
    const orders = new Set([1, 2, ...engine.gasOrders]);
    for (const [kind, pairs] of Object.entries(kinds)) {
      if (kind === "moment" && !engine.known) continue;
      const sizes = Object.entries(pairs).map(([n, [a, b]]) => [Number(n), size(a) + size(b)]);
      const most = Math.max(...sizes.map(([, each]) => each));
      for (const [n, each] of sizes) if (n && each > shown * most) orders.add(n);
    }
    return [...orders].sort((a, b) => a - b);
  }

  // Which of force and moment of an order are large, and a device for each direction in which a large vector turns; as `analysis.verdict` finds them.
  function judgeOrder(engine, { steps: [{ kinds }], scale }, { small }, order) {
    const large = [], due = new Set();
    for (const kind of engine.known ? ["force", "moment"] : ["force"]) {
      const [forward, backward] = (kinds[kind][order] || NONE).map(size), least = small * scale[kind];
      if (!isSmall(forward, least)) due.add(1);
      if (!isSmall(backward, least)) due.add(-1);
      if (!isSmall(Math.max(forward, backward), least)) large.push(kind);
    }
    if (engine.crossheads && order <= 2) return { order, large, cures: [] };      // compensators take the place of shafts
    const turns = (d, ratio) => d.kind !== "slider" && d.order === order && size(ratio > 0 ? d.forward : d.backward) > 0;
    const cures = [order, -order].filter((ratio) => due.has(Math.sign(ratio))).map((ratio) => ({
      ratio, on_crank: ratio === 1, further: engine.devices.some((d) => turns(d, ratio)),
    }));
    return { order, large, cures };
  }
  const judge = (engine, ladder, limits) =>
    listShown(engine, ladder, limits).map((order) => judgeOrder(engine, ladder, limits, order)).filter(({ large }) => large.length);

  // ------------------------------------------------------------------ the document
  const first = (c, n) => { const at = (deg(-Math.atan2(c[1], c[0])) % 360 + 360) % 360 / n; return at < 360 / n ? at : 0; };
  function describeVector([a, b], n, words = [], up = 0) {
    const major = size(a) + size(b), axis = deg(Math.atan2(a[1], a[0]) + Math.atan2(b[1], b[0])) / 2;
    const component = (c) => ({ amplitude: size(c), phase_deg: n && size(c) ? deg(-Math.atan2(c[1], c[0])) : null });
    const along = ([p, q]) => [component(add(p, [q[0], -q[1]])), component([p[1] + q[1], q[0] - p[0]])];
    const [x, y] = along([a, b]), turned = along([a, b].map((v) => times(v, polar(1, rad(-up)))));
    const line = n && size(a) && size(b);                     // order 0 is a constant vector
    return {
      forward: a, backward: b, major, minor: Math.abs(size(a) - size(b)) * (n ? 1 : 0),
      axis_deg: line ? 90 - ((90 - axis) % 180 + 180 + 1e-6) % 180 + 1e-6 : !n && size(a) ? deg(Math.atan2(a[1], a[0])) : null,
      x, y, balanced: !major, ...Object.fromEntries(words.map((word, k) => [word, turned[k]])),
    };
  }
  function describeScalar([a], n) {
    const c = scaled(a, n ? 2 : 1);
    return { cos: c[0], sin: -c[1] || 0, amplitude: size(c), peak_deg: n && size(c) ? first(c, n) : null, balanced: !size(c) };
  }
  const describePeak = ({ force, moment }) => ({
    force_N: force.value, force_deg: force.theta === null ? null : deg(force.theta),
    moment_Nm: moment.value, moment_deg: moment.theta === null ? null : deg(moment.theta),
  });

  // Orders 0 to 12, verdict, peaks and ladder as in the output of `balcli analyze -f json`.
  function describe(engine, ladder, limits) {
    const { kinds, peak } = ladder.steps[0], known = engine.known;
    const vector = (kind, n) => describeVector(kinds[kind][n], n, engine.up === null ? [] : UPRIGHT[kind], engine.up);
    const orders = Array.from({ length: ORDERS + 1 }, (_, n) => ({
      order: n, force_N: vector("force", n), moment_Nm: vector("moment", n),
      couple_Nm: describeScalar(kinds.couple[n], n), inertia_torque_Nm: describeScalar(kinds.torque[n], n),
      roll_Nm: describeScalar(kinds.roll[n], n),
    }));
    const steps = ladder.steps.map(({ step, devices, peak: left }) => ({
      step, peak_force_N: left.force.value, ...(known ? { peak_moment_Nm: left.moment.value } : {}),
      counterweights: devices.filter((d) => d.kind === "counterweight").length,
      shafts: new Set(devices.filter((d) => d.kind === "shaft").map((d) => d.ratio)).size,
      mass_kg: sum(devices.map((d) => d.U)) / engine.r,
    }));
    const scale = { force_N: ladder.scale.force, ...(known ? { moment_Nm: ladder.scale.moment } : {}) };
    return {
      format: "balcli.analysis/1", speed_rpm: engine.omega * 60 / TURN, reference_mm: engine.reference.map((v) => 1e3 * v),
      orders, verdict: { matter: judge(engine, ladder, limits) }, peak: describePeak(peak), ladder: { scale, steps },
    };
  }
  return { assemble, compute, findLadder, describe, listShown, load };
})();
