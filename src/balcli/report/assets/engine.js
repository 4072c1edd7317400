"use strict";
// Free forces and moments of an engine: exact motions at even crank angles, summed, and a Fourier
// transform. This calculation shares no code with the Python program. Vectors in the plane are
// [x, y]; SI units and radians unless a name says mm or deg.
const Kernel = (() => {
  const TURN = 2 * Math.PI, SAMPLES = 256, ORDERS = 12, ROUNDING = 4e-15, NONE = [[0, 0], [0, 0]], ONE_PLACE = 1e-9;
  const WEIGHTS = "counterweights", AT_THROWS = "counterweights at every throw", MOST_STARS = 8;
  const LONG_STROKE = 1, LONG_STROKE_IN_BORES = 2.5;          // m, and in bores: only crosshead engines have longer strokes
  const STEEL = 7850, SHARE_OF_DISTANCE = 0.7;                // kg/m3; radius of the room over piston pin distance, without a skirt
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
        number: c.number, throw: c.throw, axis: rad(form(c.axis)), lead: rad(form(c.lead)), by: c.by, z: form(c.z) / 1e3, r, l, e,
        reciprocating: piston + rod.small, rotating: throwMass + rod.big + c.extra, H: rod.H,
      };
    });
    const of = (number) => cylinders.find((c) => c.number === number), first = of(1);
    const top = (number) => number === null ? 0 : Math.asin(of(number).e / (of(number).r + of(number).l));
    for (const c of cylinders) c.bank = Math.round(c.axis * 1e9);                    // cylinders with one axis are a bank
    for (const c of cylinders) c.psi = first.axis + c.lead + top(c.by) - top(first.by) - c.axis;
    const places = data.throws.map((each) => form(each) / 1e3), pins = data.pins.map((each) => form(each) / 1e3);
    const middle = (Math.min(...places) + Math.max(...places)) / 2;
    const reference = data.reference ? data.reference.map((v) => v / 1e3) : [0, 0, middle];
    const bore = take("piston.bore") / 1e3, throws = joinThrows(cylinders, pins, bore, data.known);
    const long = 2 * r > LONG_STROKE || (bore && 2 * r > LONG_STROKE_IN_BORES * bore);
    const crossheads = data.strokes === 2 && (long || data.cylinders.some((c) => take(c.crosshead) > 0));
    for (const each of throws) each.z = sum(each.files.map((number) => places[number])) / each.files.length;
    return {
      omega, r, cylinders, throws, reference, devices: listDevices(numbers, first.axis), firstAxis: first.axis,
      room: data.room, known: data.known, up: data.up, gasOrders: data.gasOrders, bore, crossheads, power: take("operation.power"),
    };
  }

  // The throws of the crank, each with the numbers of the file's throws that form it. Throws of the file at the same
  // angle form one throw if they have one place, or if they are neighbours less than half a bore apart that carry
  // rods of different banks, as in a file with a throw for each cylinder.
  function joinThrows(cylinders, pins, bore, known) {
    const round = (angle) => ((Math.round(deg(angle) * 1e6) / 1e6) % 360 + 360) % 360;
    const each = pins.map((z, number) => {
      const own = cylinders.filter((c) => c.throw === number);
      const angles = [...new Set(own.map((c) => round(c.axis + c.psi)))].sort((a, b) => a - b);
      return { number, z, place: Math.round(z * 1e9), angles, banks: own.map((c) => round(c.axis)) };
    });
    if (!known) return each.map(({ number }) => ({ files: [number] }));
    each.sort((a, b) => a.place - b.place || a.angles[0] - b.angles[0] || a.number - b.number);
    const joined = [];
    for (const one of each) {
      const before = joined.at(-1), apart = before && Math.abs(one.z - before.at(-1).z);
      const sameBank = before?.some(({ banks }) => banks.some((bank) => one.banks.includes(bank)));
      const near = before && (apart < ONE_PLACE || (apart < bore / 2 && !sameBank));
      if (near && String(before[0].angles) === String(one.angles)) before.push(one);
      else joined.push([one]);
    }
    return joined.map((throws) => ({ files: throws.map(({ number }) => number) }));
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

  // ------------------------------------------------------------------ one cylinder
  // Force [x, y], couples by rod and by piston offset, and inertia torque of a cylinder at a crank angle.
  function loadOf(engine, c, theta) {
    const square = engine.omega ** 2, psi = theta + c.psi, lam = c.r / c.l, sine = lam * Math.sin(psi) - c.e / c.l;
    const cosine = Math.sqrt((1 - sine) * (1 + sine)), beta1 = lam * Math.cos(psi) / cosine;
    const beta2 = (sine * beta1 ** 2 - lam * Math.sin(psi)) / cosine;
    const s1 = -c.r * Math.sin(psi) - c.l * sine * beta1;
    const s2 = -c.r * Math.cos(psi) - c.l * (cosine * beta1 ** 2 + sine * beta2);
    const along = -c.reciprocating * s2 + c.rotating * c.r * Math.cos(psi);
    return {
      force: scaled(times([along, c.rotating * c.r * Math.sin(psi)], polar(1, c.axis)), square),
      rod: -square * c.H * beta2, offset: square * c.reciprocating * c.e * s2,
      torque: -square * (c.reciprocating * s1 * s2 - c.H * beta1 * beta2),
    };
  }
  // Loads of each cylinder at all sampled crank angles.
  const sample = (engine) => engine.cylinders.map((c) =>
    Array.from({ length: SAMPLES }, (_, k) => loadOf(engine, c, TURN * k / SAMPLES)));
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

  // Sums over the cylinders at each sampled crank angle, with `weightOf` as factor of each cylinder.
  function addUp(samples, read, weightOf = () => 1) {
    const weights = samples.map((_, row) => weightOf(row));
    return samples[0].map((_, k) => {
      let x = 0, y = 0;
      samples.forEach((loads, row) => {
        const [u, v] = read(loads[k]);
        x += weights[row] * u; y += weights[row] * v;
      });
      return [x, y];
    });
  }

  // Phasors by kind and order, and peaks; cylinders are sampled, devices are computed in closed form.
  function compute(engine, samples = sample(engine)) {
    const most = bound(engine), arm = armOf(engine, [0, 0]);
    const series = (values, limit) => transform(values, SAMPLES / 2 - 1).map((pair) =>
      pair.map((v) => size(v) <= ROUNDING * limit ? [0, 0] : v));
    const about = (read) => series(addUp(samples, (load) => [read(load), 0]), most.about);
    const coupleOf = ({ rod, offset, force }) => rod + offset + cross(arm, force);
    const kinds = {
      force: series(addUp(samples, ({ force }) => force), most.force),
      moment: series(addUp(samples, ({ force: [x, y] }) => [-y, x], (row) => engine.cylinders[row].z - engine.reference[2]), most.moment),
      couple: about(coupleOf), torque: about(({ torque }) => torque), roll: about((load) => coupleOf(load) - load.torque),
    };
    return { ...addDevices(engine, kinds, engine.devices), samples };
  }

  // Which causes change the couple in these orders: rods, then offset pistons, then lines of force that miss the reference.
  function findCauses(engine, { kinds: { couple }, samples }, orders, least) {
    const series = (read) => transform(addUp(samples, (load) => [read(load), 0]), Math.max(...orders));
    const rods = series(({ rod }) => rod), offsets = series(({ offset }) => offset), none = couple.map(() => NONE);
    const changes = (from, to) => orders.some((n) => 2 * size(add(to[n][0], scaled(from[n][0], -1))) > least);
    const both = rods.map((pair, n) => [add(pair[0], offsets[n][0])]);
    const causes = [];
    if (changes(none, rods)) causes.push("rods");
    if (changes(rods, both)) causes.push("offset_pistons");
    if (changes(both, couple)) causes.push("reference_point");
    return causes;
  }

  // ------------------------------------------------------------------ main bearings
  // Bearings half-way between throws and as far outside the end throws, each with the phasors of its load by the
  // cylinders and counterweights next to it (lever rule); none if throws stand in one plane, or places are unknown.
  function findBearings(engine, samples) {
    const places = [...new Set(engine.throws.map(({ z }) => Math.round(z * 1e12) / 1e12))].sort((a, b) => a - b);
    if (!engine.known || places.length < 2) return [];
    const between = places.slice(1).map((z, k) => (z + places[k]) / 2);
    const all = [2 * places[0] - between[0], ...between, 2 * places.at(-1) - between.at(-1)];
    const shares = engine.cylinders.map((c) => shareLoad(all, c.z));
    return all.map((_, k) => {
      const phasors = transform(addUp(samples, ({ force }) => force, (row) => shares[row][k]), SAMPLES / 2 - 1);
      const carry = (z) => shareLoad(all, z)[k];
      return { carry, phasors: addWeights({ carry, phasors }, engine, engine.devices) };
    });
  }
  // Shares of a load at z that each bearing carries.
  function shareLoad(bearings, z) {
    const left = Math.min(Math.max(bearings.findLastIndex((at) => at <= z), 0), bearings.length - 2);
    const right = (z - bearings[left]) / (bearings[left + 1] - bearings[left]);
    return bearings.map((_, k) => k === left ? 1 - right : k === left + 1 ? right : 0);
  }
  // Phasors of a bearing's load with counterweights, which change order 1 alone.
  function addWeights({ carry, phasors }, { omega }, devices) {
    const sums = [...phasors];
    for (const { kind, forward, z } of devices) {
      if (kind === "counterweight") sums[1] = [add(sums[1][0], scaled(forward, carry(z) * omega ** 2)), sums[1][1]];
    }
    return sums;
  }
  // The largest load of a bearing over a revolution, with further counterweights; null without bearings.
  function findMainLoad(engine, bearings, devices) {
    if (!bearings.length) return null;
    return Math.max(...bearings.map((bearing) => findPeak(addWeights(bearing, engine, devices), 1e-11).value));
  }

  // Phasors and peaks with devices: each device adds to one order.
  function addDevices(engine, kinds, devices) {
    const sums = Object.fromEntries(Object.entries(kinds).map(([kind, pairs]) => [kind, pairs.slice()]));
    const drop = (v, part) => size(v) <= 2e-11 * size(part) ? [0, 0] : v;                 // as core/loads.py
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
  function findPeak(phasors, least = 1e-14) {
    const total = sum(phasors.map(([a, b]) => size(a) + size(b)));
    const orders = [];
    phasors.forEach(([a, b], n) => { if (size(a) + size(b) > least * total) orders.push({ n, a, b }); });
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
      tops.push({ value: size(value(theta, 0)), theta: TURN - at < 1e-6 ? 0 : at });
    });
    const top = Math.max(...tops.map((each) => each.value));
    return tops.filter((each) => each.value >= top - 1e-12 * total).sort((a, b) => a.theta - b.theta)[0];
  }

  // ------------------------------------------------------------------ the ladder
  // A part is small if it is 0 or below a limit; a part of just this size is not small.
  const isSmall = (value, least) => !value || value < least * (1 - 1e-9);

  // Force and moment of one cylinder's first order.
  function findScale(engine) {
    const z = engine.cylinders.map((c) => c.z), length = Math.max(Math.max(...z) - Math.min(...z), 2 * engine.r);
    const force = Math.max(...engine.cylinders.map((c) => c.reciprocating * c.r)) * engine.omega ** 2;
    return { force, moment: force * length, length };
  }

  // Force and moment of an order that turn in one direction; the moment as the force times its distance, [0, 0] if unknown.
  function findPart(engine, kinds, order, sense) {
    const [force, moment] = ["force", "moment"].map((kind) => kinds[kind][order][sense > 0 ? 0 : 1]);
    return { order, sense, force, moment: engine.known ? [moment[1], -moment[0]] : [0, 0] };
  }

  // Devices that balance the engine step by step. `limits` are those of the command: small, shown, rounding, and
  // from which share of one cylinder's first order a shaft is worth fitting.
  function findLadder(engine, limits) {
    const drawn = compute(engine), scale = findScale(engine), bearings = findBearings(engine, drawn.samples);
    const makeStep = (step, devices) => ({
      step, devices, ...addDevices(engine, drawn.kinds, devices), mainLoad: findMainLoad(engine, bearings, devices),
    });
    const steps = [makeStep("as drawn", [])], leftOut = [];
    let listed = [];
    const ladder = { engine, limits, drawn, scale, makeStep, steps };
    const consider = (offer) => {
      if (!offer.listed) return leftOut.push(offer);
      listed = [...offer.step === AT_THROWS ? [] : listed, offer];              // these replace those in the end planes
      return steps.push({ ...offer, ...makeStep(offer.step, listed.flatMap(({ own }) => own)) });
    };
    consider(offerWeights(ladder));
    for (const offer of offerWeightsAtThrows(ladder, listed)) consider(offer);
    const others = engine.crossheads ? offerCompensators(ladder) : offerShafts(ladder);
    others.forEach(consider);
    const replaces = steps.some(({ step }) => step === AT_THROWS), settled = steps.some((each) => each.takesBack);
    const usual = steps.filter(({ step, order, worthIt }) =>
      worthIt && !(replaces && step === WEIGHTS) && !(settled && order === 1));
    return {
      steps, scale, drawn, makeStep, auto: usual.map(({ step }) => step),
      leftOut: leftOut.filter(({ step, cancels, own }) => (cancels.share || own.length) && !(replaces && step === WEIGHTS)),
    };
  }

  // What a step cancels: its largest rotating force and moment, and the larger of both as a share of one cylinder's.
  function measure(ladder, parts) {
    const force = Math.max(0, ...parts.map((part) => size(part.force)));
    const moment = Math.max(0, ...parts.map((part) => size(part.moment)));
    return { force, moment, share: Math.max(0, ...parts.map((part) => shareOf(ladder, part))) };
  }
  const shareOf = ({ scale }, { force, moment }) =>
    Math.max(size(force) && size(force) / scale.force, size(moment) && size(moment) / scale.moment);

  function offerWeights(ladder) {
    const { engine, limits, drawn } = ladder, part = findPart(engine, drawn.kinds, 1, 1);
    const cancels = measure(ladder, [part]), listed = !isSmall(cancels.share, limits.small);
    const own = listed ? cancel(ladder, part) : [], [ahead, against] = drawn.kinds.moment[1].map(size);
    const worthIt = !engine.crossheads || isLikely(ladder, ahead + against);
    return { step: WEIGHTS, order: 1, listed, own, cancels, worthIt, takesBack: takesBack(ladder, own) };
  }

  // The step with a counterweight at every throw, if the crank has throws in three or more planes.
  function offerWeightsAtThrows(ladder, listed) {
    const { engine, limits, scale, makeStep, steps } = ladder;
    const planes = new Set(engine.throws.map(({ z }) => z)), load = steps.at(-1).mainLoad;
    if (load === null || planes.size < 3) return [];
    const own = placeAtThrows(ladder), fall = load - makeStep(AT_THROWS, own).mainLoad;
    const relieves = fall > limits.rounding * load && !isSmall(fall, limits.small * scale.force);
    const cancels = measure(ladder, listed.length ? [] : [findPart(engine, ladder.drawn.kinds, 1, 1)]);
    return [{
      step: AT_THROWS, order: 1, listed: relieves && !engine.crossheads, own, cancels, fall, worthIt: true,
      takesBack: takesBack(ladder, own),
    }];
  }

  // A counterweight at each throw against the force of its cylinders that turns with the crank, less the file's
  // counterweights at the nearest throw. The smallest additions cancel what is left of force and moment.
  function placeAtThrows(ladder) {
    const { engine, drawn: { kinds, samples } } = ladder, square = engine.omega ** 2, zr = engine.reference[2];
    const places = engine.throws.map(({ z }) => z), weights = places.map(() => [0, 0]);
    engine.cylinders.forEach((c, row) => {
      const [[forward]] = transform(samples[row].map(({ force }) => force), 1).slice(1);
      const at = engine.throws.findIndex(({ files }) => files.includes(c.throw));
      weights[at] = add(weights[at], scaled(forward, -1 / square));
    });
    for (const device of engine.devices.filter(({ kind }) => kind === "counterweight")) {
      const far = places.map((z) => Math.abs(z - device.z)), at = far.indexOf(Math.min(...far));
      weights[at] = add(weights[at], scaled(device.forward, -1));
    }
    const { force, moment } = findPart(engine, kinds, 1, 1), total = sumMovingMasses(engine);
    const left = (vectors, start) => vectors.reduce(add, scaled(start, 1 / square));
    const f = left(weights, force), m = left(weights.map((v, k) => scaled(v, places[k] - zr)), moment);
    if (size(f) > 1e-13 * total || size(m) > 1e-13 * total * ladder.scale.length) {
      const middle = sum(places) / places.length, spread = sum(places.map((z) => (z - middle) ** 2));
      const tilt = scaled(add(m, scaled(f, zr - middle)), -1 / spread), shift = scaled(f, -1 / places.length);
      places.forEach((z, k) => { weights[k] = add(weights[k], add(shift, scaled(tilt, z - middle))); });
    }
    return makeWeights(ladder, weights.map((v, k) => [v, places[k]]));
  }
  const sumMovingMasses = (engine) => sum(engine.cylinders.map((c) => (c.reciprocating + c.rotating) * c.r));
  const makeWeights = ({ engine, limits }, pairs) => pairs
    .filter(([v]) => size(v) > limits.rounding * sumMovingMasses(engine))
    .map(([[x, y], z]) => makeDevice("counterweight", Math.hypot(x, y), Math.atan2(y, x), z));

  // Whether new counterweights work against those of the file, in force and moment together.
  function takesBack({ engine, scale }, own) {
    const ofFile = engine.devices.filter(({ kind }) => kind === "counterweight"), zr = engine.reference[2];
    const total = (devices, armOf) => devices.reduce((v, d) => add(v, scaled(d.forward, armOf(d))), [0, 0]);
    const dot = (armOf) => { const [a, b] = [ofFile, own].map((devices) => total(devices, armOf)); return a[0] * b[0] + a[1] * b[1]; };
    const product = dot(() => 1) + (engine.known ? dot(({ z }) => z - zr) / scale.length ** 2 : 0);
    return product < -1e-9 * sum(ofFile.map(({ U }) => U)) * sum(own.map(({ U }) => U));
  }

  // The steps with shafts for order 1, against the crank, and for order 2.
  function offerShafts(ladder) {
    const { engine, limits, drawn } = ladder, cylinders = Math.max(engine.cylinders.length, limits.fewest);
    const all = [{ order: 1, senses: [-1], limit: limits.worth1 }, { order: 2, senses: [1, -1], limit: limits.worth2 * cylinders }];
    return all.flatMap(({ order, senses, limit }) => {
      const parts = senses.map((sense) => findPart(engine, drawn.kinds, order, sense));
      const due = parts.filter((part) => !isSmall(shareOf(ladder, part), limits.small));
      const named = due.length ? due : parts.filter((part) => shareOf(ladder, part));
      if (!named.length) return [];
      const step = named.length > 1 ? "shafts at +2 and -2" : `shaft at ${named[0].sense > 0 ? "+" : "-"}${order}`;
      const worthIt = !isSmall(Math.max(...parts.map((part) => shareOf(ladder, part))), limit);
      return [{ step, order, listed: due.length > 0, own: due.flatMap((part) => cancel(ladder, part)), cancels: measure(ladder, named), worthIt }];
    });
  }

  // The steps with pairs of masses at both ends, for the moment about y that counterweights leave.
  function offerCompensators(ladder) {
    const { engine, limits, scale, steps } = ladder;
    return (engine.known ? [1, 2] : []).map((order) => {
      const [ahead, against] = [1, -1].map((sense) => findPart(engine, steps.at(-1).kinds, order, sense).moment);
      const turning = add(ahead, [against[0], -against[1]]), moment = size(turning) > limits.rounding * scale.moment ? size(turning) : 0;
      const listed = !isSmall(moment / scale.moment, limits.small);
      return {
        step: `compensators of order ${order}`, order, listed, own: listed ? compensate(engine, order, turning) : [],
        cancels: { force: 0, moment, share: moment && moment / scale.moment }, worthIt: isLikely(ladder, moment),
      };
    });
  }
  // Whether the power related unbalance of a moment, N m/kW, makes compensators likely; not without a known power.
  const isLikely = ({ engine, limits }, moment) => engine.power > 0 && moment / engine.power > limits.likely;

  // The end planes: the first and the last throw; for throws in one plane, half a bore on either side of it.
  function findEnds(engine) {
    const z = engine.throws.map((each) => each.z), [low, high] = [Math.min(...z), Math.max(...z)], half = engine.bore / 2 || engine.r;
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
  function cancel(ladder, { order, sense, force: f, moment: m }) {
    const { engine, scale } = ladder, onCrank = order * sense === 1, per = -1 / (order * engine.omega) ** 2;
    const [low, high] = findEnds(engine), zr = engine.reference[2];
    const make = ([x, y], z) => makeDevice("shaft", Math.hypot(x, y), Math.atan2(y, x), z, sense * order);
    if (!onCrank && size(f)) {
      const reach = [...engine.throws, ...engine.cylinders].map(({ z }) => z);
      const at = zr + (m[0] * f[0] + m[1] * f[1]) / size(f) ** 2;
      const z = Math.min(Math.max(at, Math.min(...reach)), Math.max(...reach));
      if (size(add(m, scaled(f, zr - z))) <= 1e-11 * (size(m) + size(f) * scale.length)) return [make(scaled(f, per), z)];
    }
    const upper = scaled(add(m, scaled(f, zr - low)), per / (high - low)), lower = add(scaled(f, per), scaled(upper, -1));
    const pair = [[lower, low], [upper, high]];
    return onCrank ? makeWeights(ladder, pair) : pair.filter(([v]) => size(v) > 0).map((each) => make(...each));
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

  // Which of force and moment of an order are large (their largest value is not small), and a device for each direction in which a vector turns that
  // is not small by itself; as `analysis.verdict` finds them.
  function judgeOrder(engine, { steps: [{ kinds }], scale }, limits, order) {
    const large = [], due = new Set();
    for (const kind of engine.known ? ["force", "moment"] : ["force"]) {
      const [forward, backward] = (kinds[kind][order] || NONE).map(size), least = limits.small * scale[kind];
      if (!isSmall(forward, least)) due.add(1);
      if (!isSmall(backward, least)) due.add(-1);
      if (!isSmall(forward + backward, least)) large.push(kind);
    }
    if (engine.crossheads && order <= 2) return { order, large };      // compensators take the place of shafts
    const settles = () => takesBack({ engine, scale }, cancel({ engine, scale, limits }, findPart(engine, kinds, 1, 1)));
    const turns = (d, ratio) => d.kind !== "slider" && d.order === order && size(ratio > 0 ? d.forward : d.backward) > 0;
    const cures = [order, -order].filter((ratio) => due.has(Math.sign(ratio))).map((ratio) => ({
      ratio, on_crank: ratio === 1, further: engine.devices.some((d) => turns(d, ratio)),
      ...(ratio === 1 && settles() ? { takes_back: true } : {}),
    }));
    return { order, large, cures };
  }
  const judge = (engine, ladder, limits, shown) =>
    shown.map((order) => judgeOrder(engine, ladder, limits, order)).filter(({ large }) => large.length);

  // The order of the largest couple among these, and what causes the couple; null if it is worth naming in none of them.
  function judgeCouple(engine, { drawn, scale }, { worthNaming }, shown) {
    const sizeOf = (n) => 2 * size((drawn.kinds.couple[n] || NONE)[0]), least = worthNaming * scale.force * engine.r;
    const orders = shown.filter((n) => !isSmall(sizeOf(n), least));
    if (!orders.length) return null;
    const largest = orders.reduce((a, b) => sizeOf(b) > sizeOf(a) ? b : a);
    return { order: largest, causes: findCauses(engine, drawn, orders, least) };
  }

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

  // A device as the command describes it, with its vectors (kg m). A shaft that makes only a moment is free.
  function describeDevice(engine, d, devices) {
    const onCrank = d.kind === "counterweight", turned = deg(d.angle - (onCrank ? engine.firstAxis : 0)) % 360;
    const angle = turned <= -180 ? turned + 360 : turned > 180 ? turned - 360 : turned;
    const same = devices.filter(({ kind, ratio }) => kind === d.kind && ratio === d.ratio), most = Math.max(...same.map(({ U }) => U));
    const free = same.length > 1 && size(same.map(({ forward, backward }) => add(forward, backward)).reduce(add)) <= 1e-12 * most;
    return {
      device: d.kind, ...(onCrank ? {} : { ratio: d.ratio, free }), at_mm: d.at.map((v) => 1e3 * v), unbalance_kg_m: d.U,
      angle_deg: angle, position_mm: 1e3 * d.z, kind: d.kind, order: d.order, forward: d.forward, backward: d.backward,
    };
  }
  // Force and moment of the orders that devices change.
  const listChanges = (devices, kinds) => [...new Set(devices.map(({ order }) => order))].sort((a, b) => a - b).map((order) =>
    ({ order, force: kinds.force[order] || NONE, moment: kinds.moment[order] || NONE }));
  function describeStep(engine, { step, devices, peak, kinds, mainLoad, takesBack }) {
    const steel = weighSteel(engine, devices);
    return {
      step, ...(takesBack ? { takes_back: true } : {}), peak_force_N: peak.force.value,
      ...(engine.known ? { peak_moment_Nm: peak.moment.value } : {}), ...(mainLoad === null ? {} : { main_bearing_N: mainLoad }),
      counterweights: devices.filter((d) => d.kind === "counterweight").length,
      shafts: new Set(devices.filter((d) => d.kind === "shaft").map((d) => d.ratio)).size,
      mass_kg: sum(devices.map((d) => d.U)) / engine.r, ...(steel === null ? {} : { steel_kg: steel }),
      devices: devices.map((d) => describeDevice(engine, d, devices)),
      changes: listChanges(devices, kinds),
    };
  }
  // Mass of half discs of steel: counterweights with the radius of the room around the crank, eccentrics of shafts as
  // long as their diameter; null if the room is not known.
  function weighSteel(engine, devices) {
    const { skirt, crankcase } = engine.room, distance = Math.min(...engine.cylinders.map(({ l, r, e }) => Math.sqrt((l - r) ** 2 - e ** 2)));
    const radius = Math.min(crankcase ?? Infinity, skirt === null ? SHARE_OF_DISTANCE * distance : distance - skirt);
    if (radius <= 0 && devices.some(({ kind }) => kind === "counterweight")) return null;
    return sum(devices.map(({ kind, U }) => kind === "counterweight" ? 3 * Math.PI * U / (4 * radius) : Math.PI * STEEL * (0.75 * U / STEEL) ** 0.75));
  }
  const describeLeftOut = (engine, { step, cancels, fall }) => ({
    step, force_N: cancels.force, ...(engine.known ? { moment_Nm: cancels.moment } : {}), ...(fall === undefined ? {} : { main_bearing_N: fall }),
  });

  // Vectors of the cylinders by order and direction of rotation, at crank angle 0, and their sums.
  function describeStars(engine, { drawn: { samples } }, orders) {
    const banks = [...new Set(engine.cylinders.map(({ bank }) => bank))], alone = banks.length > 2 && banks.length === engine.cylinders.length;
    const most = bound(engine), pairs = samples.map((loads) => transform(loads.map(({ force }) => force), SAMPLES / 2 - 1));
    const polarOf = (force, moment) => ({
      force_N: size(force), force_deg: angleOf(force), ...(engine.known ? { moment_Nm: size(moment), moment_deg: angleOf(moment) } : {}),
    });
    const drop = (v, limit) => size(v) <= ROUNDING * limit ? [0, 0] : v;
    const total = (rays) => polarOf(drop(rays.map(({ f }) => f).reduce(add, [0, 0]), most.force), drop(rays.map(({ m }) => m).reduce(add, [0, 0]), most.moment));
    return orders.filter((n) => n > 0).flatMap((order) => ["forward", "backward"].flatMap((turns, way) => {
      const rays = engine.cylinders.map((c, row) => {
        const f = drop((pairs[row][order] || NONE)[way], most.force);
        return { c, f, m: momentOf(engine, f, c.z) };
      });
      if (!rays.some(({ f }) => size(f))) return [];
      const groups = (alone ? [rays] : banks.map((bank) => rays.filter(({ c }) => c.bank === bank)));
      return [{
        order, turns, ...total(rays), banks: groups.map((own) => ({
          axis_deg: alone ? null : deg(own[0].c.axis), ...total(own),
          cylinders: own.map(({ c, f, m }) => ({ cylinder: c.number, ...polarOf(f, m) })).sort((a, b) => a.cylinder - b.cylinder),
        })),
      }];
    })).slice(0, MOST_STARS);
  }
  const angleOf = (v) => size(v) ? (deg(Math.atan2(v[1], v[0])) % 360 + 360) % 360 : null;

  // After which angle the size of a vector repeats, deg; 0 if it is constant.
  function findRepeat(pairs) {
    const speeds = pairs.flatMap(([a, b], n) => [...size(a) ? [n] : [], ...size(b) ? [-n] : []]);
    const step = speeds.reduce((common, speed) => divisor(common, Math.abs(speed - speeds[0])), 0);
    return step ? 360 / step : 0;
  }
  const divisor = (a, b) => b ? divisor(b, a % b) : a;

  // The steps that are fitted by default, if they are not those of a row.
  function describeUsual(engine, { steps, auto, makeStep }) {
    const own = (last) => steps.slice(1, last + 1).map(({ step }) => step).filter((step, _, all) => !(step === WEIGHTS && all.includes(AT_THROWS)));
    if (steps.some((_, k) => String(own(k)) === String(auto))) return [];
    const chosen = steps.filter(({ step }) => auto.includes(step)), numbers = chosen.map((each) => steps.indexOf(each)).join(" and ");
    return [describeStep(engine, { ...makeStep(`default: steps ${numbers}`, chosen.flatMap((each) => each.own)), takesBack: false })];
  }

  // Orders, verdict, peaks, ladder and stars as in the output of `balcli analyze --why -f json`; under "page" what only the page needs.
  function describe(engine, ladder, limits, orders = listShown(engine, ladder, limits)) {
    const { kinds, peak } = ladder.steps[0], { known } = engine, shown = listShown(engine, ladder, limits);
    const vector = (kind, n) => describeVector(kinds[kind][n] || NONE, n, engine.up === null ? [] : UPRIGHT[kind], engine.up);
    const scalar = (kind, n) => describeScalar(kinds[kind][n] || NONE, n), couple = judgeCouple(engine, ladder, limits, shown);
    const scale = { force_N: ladder.scale.force, ...(known ? { moment_Nm: ladder.scale.moment } : {}) };
    return {
      format: "balcli.analysis/1", speed_rpm: engine.omega * 60 / TURN, reference_mm: engine.reference.map((v) => 1e3 * v),
      orders: orders.map((order) => ({
        order, force_N: vector("force", order), moment_Nm: vector("moment", order), couple_Nm: scalar("couple", order),
        inertia_torque_Nm: scalar("torque", order), roll_Nm: scalar("roll", order),
      })),
      verdict: { matter: judge(engine, ladder, limits, shown), ...(couple ? { couple } : {}) }, peak: describePeak(peak),
      ladder: {
        scale, auto: ladder.auto, steps: ladder.steps.map((step) => describeStep(engine, step)),
        left_out: ladder.leftOut.map((offer) => describeLeftOut(engine, offer)),
      },
      stars: describeStars(engine, ladder, shown),
      page: {
        extra: describeUsual(engine, ladder), crossheads: engine.crossheads, scales: { moment_Nm: ladder.scale.moment, roll_Nm: ladder.scale.force * engine.r },
        every: { force: findRepeat(kinds.force), moment: findRepeat(kinds.moment) }, devices: engine.devices.map((d) => describeDevice(engine, d, engine.devices)),
      },
    };
  }
  return { assemble, compute, findLadder, describe, listShown };
})();
