"use strict";
// Free forces and moments of an engine: exact motions at even crank angles, summed, and a Fourier
// transform. This calculation shares no code with the Python program.
//
// Vectors in the plane are [x, y] and stand for the complex number x + iy. SI units and radians,
// unless a name says mm or deg. An order n of a vector has two phasors, `forward` and `backward`:
//   v(θ) = Σ forward[n] e^(inθ) + backward[n] e^(-inθ)
// A quantity about the crank axis (couple, torque, roll) is a vector along x: backward is the
// conjugate of forward.
const Kernel = (() => {
  const TURN = 2 * Math.PI;
  const SAMPLES = 256;                                        // crank angles in a revolution, a power of 2
  const MOST = SAMPLES / 2 - 1;                               // the highest order
  const ROUNDING = 4e-15;                                     // share of the sum of all sizes
  const ONE_PLACE = 1e-9;                                     // m
  const GRAVITY = 9.80665;                                    // m/s²
  const MOST_STARS = 8;
  const STEEL = 7850;                                         // kg/m³
  const SHARE_OF_DISTANCE = 0.7;                              // radius of the room over piston pin distance, without a skirt
  const NONE = [[0, 0], [0, 0]];                              // both phasors of an order that is balanced
  const WEIGHTS = "counterweights";
  const AT_THROWS = "counterweights at every throw";
  const UPRIGHT = { force: ["vertical", "horizontal"], moment: ["yawing", "pitching"] };

  const rad = (deg) => deg * TURN / 360;
  const deg = (angle) => angle * 360 / TURN;
  const sum = (values) => values.reduce((total, value) => total + value, 0);
  const largest = (values) => values.reduce((most, value) => Math.max(most, value), 0);

  // ------------------------------------------------------------------ vectors in the plane
  const polar = (size, angle) => [size * Math.cos(angle), size * Math.sin(angle)];
  const add = (a, b) => [a[0] + b[0], a[1] + b[1]];
  const scaled = (a, factor) => [a[0] * factor, a[1] * factor];
  const times = (a, b) => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];   // complex product
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1];
  const cross = (a, b) => a[0] * b[1] - a[1] * b[0];
  const conjugate = ([x, y]) => [x, -y];
  const size = ([x, y]) => Math.sqrt(x * x + y * y);          // Math.hypot is ten times slower
  const angleOf = ([x, y]) => Math.atan2(y, x);
  const addAll = (vectors) => vectors.reduce(add, [0, 0]);
  const wrapDeg = (angle) => (angle % 360 + 360) % 360;       // to 0 … 360

  // ------------------------------------------------------------------ numbers -> engine
  // Masses at the ends of a rod (kg), and H (kg m²), by which their moment of inertia exceeds the rod's.
  //   small end: m s/l with the centre of mass s from the crank pin
  //   H = m s (l - s) - J
  function weighRod(rod, take, length) {
    let small = rod.small_end ? take(rod.small_end) : 0;
    let big = rod.big_end ? take(rod.big_end) : 0;
    if (!rod.small_end && !rod.big_end && rod.mass) {
      const share = (rod.cg ? take(rod.cg) : 0) / 1e3 / length;
      small = take(rod.mass) * share;
      big = take(rod.mass) * (1 - share);
    }
    const mass = small + big;
    const share = mass ? small / mass : 0;
    const ofPoints = mass * share * (1 - share) * length * length;
    const inertia = findInertia(rod, take, { mass, share, length, ofPoints });
    const excess = ofPoints - inertia;
    const rounding = 1.8e-15 * (ofPoints + Math.abs(inertia));
    return { small, big, H: Math.abs(excess) > rounding ? excess : 0, outside: inertia < 0 };
  }

  // Moment of inertia of a rod about its centre of mass: as the file gives it, from a pendulum test, or that of the
  // masses at its ends.
  //   pendulum of period T about a pivot at distance a: J = m a (g (T/2π)² - a)
  function findInertia(rod, take, { mass, share, length, ofPoints }) {
    if (rod.inertia) return take(rod.inertia) / 1e6;
    if (!rod.period) return ofPoints;
    const arm = length * (rod.pivot === "big_end" ? share : 1 - share);
    return mass * arm * (GRAVITY * (rod.period / TURN) ** 2 - arm);
  }

  // The engine of the page's data with these numbers (by dotted name); an Error states what is wrong.
  function assemble(data, numbers) {
    const take = (name) => numbers[name] ?? 0;
    const entries = data.cylinders.map((own) => ({ ...data.ofEachCylinder, ...own }));
    const cylinders = entries.map((entry) => assembleCylinder(entry, take));
    turnPins(cylinders);
    const r = take("crank.stroke") / 2e3;
    const bore = take("piston.bore") / 1e3;
    const places = data.throws.map((form) => evaluate(form, take) / 1e3);
    const pins = data.pins.map((form) => evaluate(form, take) / 1e3);
    const throws = joinThrows(cylinders, pins, bore, data.known);
    for (const each of throws) each.z = sum(each.files.map((number) => places[number])) / each.files.length;
    const middle = (Math.min(...places) + Math.max(...places)) / 2;
    const firstAxis = findFirst(cylinders).axis;
    const limits = data.crossheadStroke;   // null: no ship's engine
    const crossheads = limits !== null
      && 2 * r > Math.max(limits.least_m, Math.min(limits.trunk_m, limits.bores * (bore || Infinity)));   // 0: not given
    if (crossheads && data.powerOfGas) {
      throw new Error("crank.stroke: so long a stroke makes it an engine with crossheads, whose compensators depend on the power "
        + "of the gas; the page does not compute it");
    }
    return {
      omega: take("operation.speed") * TURN / 60,
      r,
      bore,
      cylinders,
      throws,
      reference: data.reference ? data.reference.map((mm) => mm / 1e3) : [0, 0, middle],
      devices: listDevices(numbers, firstAxis),
      firstAxis,
      known: data.known,
      up: data.up,
      gasOrders: data.gasOrders,
      skirt: data.skirt === null ? null : data.skirt / 1e3,
      bearings: data.bearings && data.bearings.map((mm) => mm / 1e3),
      crankcase: data.crankcase === null ? Infinity : data.crankcase / 1e3,
      crossheads,
      power: take("operation.power"),
    };
  }
  const findFirst = (cylinders) => cylinders.find(({ number }) => number === 1);

  // Value of a linear function of numbers.
  function evaluate({ value, by }, take) {
    const parts = Object.entries(by).map(([name, factor]) => factor * take(name));
    return value + sum(parts);
  }

  // Geometry and masses of a cylinder. `axis`: its direction; `lead`: of its crank pin before that of cylinder 1.
  function assembleCylinder(cylinder, take) {
    const { rod } = cylinder;
    const r = take("crank.stroke") / 2e3;
    const l = rod.length ? take(rod.length) / 1e3 : r / take(rod.ratio);
    const e = take(cylinder.offset) / 1e3;
    if (!(r / l + Math.abs(e) / l < 1)) {
      throw new Error(`${rod.length || rod.ratio}: the crank cannot turn: lambda = ${(r / l).toPrecision(4)} and offset over `
        + `length = ${(Math.abs(e) / l).toPrecision(4)} must stay below 1 together; make the rod longer`);
    }
    const weighed = weighRod(rod, take, l);
    if (weighed.outside) {
      throw new Error(`${rod.cg || "rod"}: is outside the rod, so two masses at its ends cannot replace the rod`);
    }
    const axis = rad(evaluate(cylinder.axis, take));
    return {
      number: cylinder.number,
      throw: cylinder.throw,
      axis,
      bank: Math.round(axis * 1e9),                           // cylinders with one axis are a bank
      lead: rad(evaluate(cylinder.lead, take)),
      by: cylinder.by,
      z: evaluate(cylinder.z, take) / 1e3,
      r,
      l,
      e,
      reciprocating: sum(cylinder.piston.map(take)) + weighed.small,
      rotating: cylinder.share * take("crank.throw_mass") + weighed.big + cylinder.extra,
      H: weighed.H,
    };
  }

  // Gives each cylinder psi, the angle of its crank pin from its axis at crank angle 0. If the firing of a cylinder
  // (`by`) determines the pin, its top dead centre counts: the pin is then at the angle asin(e / (r + l)).
  function turnPins(cylinders) {
    const first = findFirst(cylinders);
    const topOf = (number) => {
      if (number === null) return 0;
      const { e, r, l } = cylinders.find((cylinder) => cylinder.number === number);
      return Math.asin(e / (r + l));
    };
    for (const cylinder of cylinders) {
      const top = topOf(cylinder.by) - topOf(first.by);
      cylinder.psi = first.axis + cylinder.lead + top - cylinder.axis;
    }
  }

  // The throws of the crank, each with the numbers of the file's throws that form it. Throws of the file at the same
  // angle form one throw if they have one place, or if they are neighbours less than half a bore apart that carry
  // rods of different banks, as in a file with a throw for each cylinder.
  function joinThrows(cylinders, pins, bore, known) {
    const roundDeg = (angle) => wrapDeg(Math.round(deg(angle) * 1e6) / 1e6);
    const ofFile = pins.map((z, number) => {
      const own = cylinders.filter((cylinder) => cylinder.throw === number);
      const angles = new Set(own.map(({ axis, psi }) => roundDeg(axis + psi)));
      return {
        number,
        z,
        place: Math.round(z / ONE_PLACE),
        angles: [...angles].sort((a, b) => a - b),
        banks: own.map(({ axis }) => roundDeg(axis)),
      };
    });
    if (!known) return ofFile.map(({ number }) => ({ files: [number] }));
    ofFile.sort((a, b) => a.place - b.place || a.angles[0] - b.angles[0] || a.number - b.number);
    const joined = [];
    for (const next of ofFile) {
      const before = joined.at(-1);
      if (before && formOneThrow(before, next, bore)) before.push(next);
      else joined.push([next]);
    }
    return joined.map((group) => ({ files: group.map(({ number }) => number) }));
  }
  function formOneThrow(before, next, bore) {
    if (String(before[0].angles) !== String(next.angles)) return false;
    const apart = Math.abs(next.z - before.at(-1).z);
    const sharesBank = before.some(({ banks }) => banks.some((bank) => next.banks.includes(bank)));
    return apart < ONE_PLACE || (apart < bore / 2 && !sharesBank);
  }

  // ------------------------------------------------------------------ devices
  // Counterweights, shafts and sliders among the numbers.
  function listDevices(numbers, firstAxis) {
    const tables = {};
    for (const [name, value] of Object.entries(numbers)) {
      const [, table, key] = name.match(/^((?:counterweight|shaft|slider)\.\d+)\.(.+)$/) || [];
      if (table) (tables[table] ??= {})[key] = value;
    }
    return Object.entries(tables).map(([table, keys]) => readDevice(table.split(".")[0], keys, firstAxis));
  }
  function readDevice(kind, keys, firstAxis) {
    const take = (key) => keys[key] ?? 0;
    const ofMass = take("mass") * take("radius") / 1e3;
    return makeDevice({
      kind,
      U: keys.unbalance === undefined ? ofMass : keys.unbalance / 1e6,
      angle: rad(take("angle")) + (kind === "counterweight" ? firstAxis : 0),
      z: take("position") / 1e3,
      ratio: take("ratio") || take("order") || 1,
      at: [take("at.1") / 1e3, take("at.2") / 1e3],
      direction: rad(take("direction")),
    });
  }

  // A device with its vectors of mass × radius U (kg m). A slider moves along a direction d:
  //   U cos(nθ + a) e^(id) = U/2 e^(i(d + a)) e^(inθ) + U/2 e^(i(d - a)) e^(-inθ)
  function makeDevice({ kind, U, angle, z, ratio = 1, at = [0, 0], direction = 0 }) {
    const device = { kind, U, angle, z, ratio, at, order: Math.abs(ratio) };
    const turning = polar(U, angle);
    if (kind === "slider") {
      const half = polar(0.5, direction);
      return { ...device, forward: times(half, turning), backward: times(half, conjugate(turning)) };
    }
    if (ratio > 0) return { ...device, forward: turning, backward: [0, 0] };
    return { ...device, forward: [0, 0], backward: turning };
  }
  const isCounterweight = ({ kind }) => kind === "counterweight";

  // ------------------------------------------------------------------ one cylinder
  // Force [x, y], couples by rod and by piston offset, and inertia torque of a cylinder at a crank angle. With the
  // own crank angle ψ, λ = r/l and derivatives with respect to the crank angle:
  //   rod angle      sin β = λ sin ψ - e/l
  //   piston pin     s = r cos ψ + l cos β
  //   along the axis F = ω² (-m_rec s″ + m_rot r cos ψ)
  //   couples        -ω² H β″ and ω² m_rec e s″
  //   torque         -ω² (m_rec s′ s″ - H β′ β″)
  function loadOf(omega, cylinder, theta) {
    const { r, l, e, H, reciprocating, rotating } = cylinder;
    const square = omega * omega;
    const psi = theta + cylinder.psi;
    const lambda = r / l;
    const sinPsi = Math.sin(psi);
    const cosPsi = Math.cos(psi);
    const sinBeta = lambda * sinPsi - e / l;
    const cosBeta = Math.sqrt((1 - sinBeta) * (1 + sinBeta));
    const beta1 = lambda * cosPsi / cosBeta;
    const beta2 = (sinBeta * beta1 * beta1 - lambda * sinPsi) / cosBeta;
    const s1 = -r * sinPsi - l * sinBeta * beta1;
    const s2 = -r * cosPsi - l * (cosBeta * beta1 * beta1 + sinBeta * beta2);
    const along = -reciprocating * s2 + rotating * r * cosPsi;
    const across = rotating * r * sinPsi;
    return {
      force: scaled(times([along, across], polar(1, cylinder.axis)), square),
      rod: -square * H * beta2,
      offset: square * reciprocating * e * s2,
      torque: -square * (reciprocating * s1 * s2 - H * beta1 * beta2),
    };
  }

  // Loads of each cylinder: for each part of a load, its values at all sampled crank angles.
  function sample({ omega, cylinders }) {
    return cylinders.map((cylinder) => {
      const parts = { x: makeSeries(), y: makeSeries(), rod: makeSeries(), offset: makeSeries(), torque: makeSeries() };
      for (let k = 0; k < SAMPLES; k++) {
        const load = loadOf(omega, cylinder, TURN * k / SAMPLES);
        [parts.x[k], parts.y[k]] = load.force;
        parts.rod[k] = load.rod;
        parts.offset[k] = load.offset;
        parts.torque[k] = load.torque;
      }
      return parts;
    });
  }
  const makeSeries = () => new Float64Array(SAMPLES);
  const armOf = (engine, [x, y]) => [x - engine.reference[0], y - engine.reference[1]];

  // Moment M_x + i M_y = i (z - z_ref) F of a force at z.
  function momentOf(engine, [x, y], z) {
    const arm = z - engine.reference[2];
    return [-arm * y, arm * x];
  }

  // ------------------------------------------------------------------ Fourier transform
  const NOTHING = makeSeries();
  const COSINES = Float64Array.from({ length: SAMPLES }, (_, k) => Math.cos(TURN * k / SAMPLES));
  const SINES = Float64Array.from({ length: SAMPLES }, (_, k) => Math.sin(TURN * k / SAMPLES));
  const BITS = Math.log2(SAMPLES);
  const REVERSED = Array.from({ length: SAMPLES }, (_, k) => {
    const digits = k.toString(2).padStart(BITS, "0");
    return parseInt([...digits].reverse().join(""), 2);
  });

  // Coefficients c[n] of Σ c[n] e^(inθ) of values along + i across at even angles; order -n stands at SAMPLES - n.
  // Radix 2 (Cooley and Tukey 1965): transforms of half the length are joined,
  //   c[n] = even[n] + e^(-2πin/N) odd[n],  c[n + N/2] = even[n] - e^(-2πin/N) odd[n]
  function findCoefficients(along, across) {
    const x = makeSeries();
    const y = makeSeries();
    for (let k = 0; k < SAMPLES; k++) {
      x[k] = along[REVERSED[k]] / SAMPLES;
      y[k] = across[REVERSED[k]] / SAMPLES;
    }
    for (let half = 1; half < SAMPLES; half *= 2) {
      const stride = SAMPLES / (2 * half);
      for (let start = 0; start < SAMPLES; start += 2 * half) {
        for (let n = 0; n < half; n++) {
          const even = start + n;
          const odd = even + half;
          const c = COSINES[n * stride];
          const s = SINES[n * stride];
          const u = x[odd] * c + y[odd] * s;
          const v = y[odd] * c - x[odd] * s;
          x[odd] = x[even] - u;
          y[odd] = y[even] - v;
          x[even] += u;
          y[even] += v;
        }
      }
    }
    return { x, y };
  }

  // Forward and backward phasors of all orders of a vector at the sampled crank angles, given by its components.
  function transform(along, across = NOTHING) {
    const { x, y } = findCoefficients(along, across);
    const phasors = [[[x[0], y[0]], [0, 0]]];
    for (let n = 1; n <= MOST; n++) {
      const m = SAMPLES - n;
      phasors.push([[x[n], y[n]], [x[m], y[m]]]);
    }
    return phasors;
  }

  // ------------------------------------------------------------------ orders
  // Largest force, moment and moment about the crank if nothing cancelled; rounding errors are compared with these.
  function findBounds(engine) {
    const square = engine.omega ** 2;
    const reference = Math.abs(engine.reference[2]);
    const toCrank = size(armOf(engine, [0, 0]));
    const bounds = { force: 0, moment: 0, about: 0 };
    for (const { reciprocating, rotating, r, e, H, z } of engine.cylinders) {
      const pull = (2 * reciprocating + rotating) * r * square;
      bounds.force += pull;
      bounds.moment += pull * (Math.abs(z) + reference);
      bounds.about += pull * (r + Math.abs(e) + toCrank) + Math.abs(H) * square;
    }
    return bounds;
  }
  const drop = (vector, bound) => size(vector) <= ROUNDING * bound ? [0, 0] : vector;

  // Sum over the cylinders of a part of their loads at each sampled crank angle; `weights`: a factor for each cylinder.
  function addUp(samples, part, weights = null) {
    const total = makeSeries();
    samples.forEach((loads, row) => {
      const values = loads[part];
      const weight = weights ? weights[row] : 1;
      if (!weight) return;
      for (let k = 0; k < SAMPLES; k++) total[k] += weight * values[k];
    });
    return total;
  }

  // Phasors by kind and order, and peaks; cylinders are sampled, devices are computed in closed form.
  function compute(engine) {
    const samples = sample(engine);
    const bounds = findBounds(engine);
    const x = addUp(samples, "x");
    const y = addUp(samples, "y");
    const torque = addUp(samples, "torque");
    const couple = addCouples(samples, armOf(engine, [0, 0]), x, y);
    const arms = engine.cylinders.map(({ z }) => z - engine.reference[2]);
    const opposite = arms.map((arm) => -arm);
    const series = (bound, along, across) =>
      transform(along, across).map(([forward, backward]) => [drop(forward, bound), drop(backward, bound)]);
    const kinds = {
      force: series(bounds.force, x, y),
      moment: series(bounds.moment, addUp(samples, "y", opposite), addUp(samples, "x", arms)),
      couple: series(bounds.about, couple),
      torque: series(bounds.about, torque),
      roll: series(bounds.about, couple.map((value, k) => value - torque[k])),
    };
    const ofCylinders = samples.map((loads) => transform(loads.x, loads.y));   // phasors of each cylinder's force
    return { ...addDevices(engine, kinds, engine.devices), samples, ofCylinders };
  }
  // Couple about the reference point, of rods, offset pistons and forces at an arm.
  function addCouples(samples, arm, x, y) {
    const ofRods = addUp(samples, "rod");
    const ofPistons = addUp(samples, "offset");
    return ofRods.map((value, k) => value + ofPistons[k] + cross(arm, [x[k], y[k]]));
  }

  // Phasors and peaks with devices: each device adds n² ω² U to the order n of its speed.
  function addDevices(engine, kinds, devices) {
    const sums = {};
    for (const [kind, phasors] of Object.entries(kinds)) sums[kind] = phasors.slice();   // orders may be missing in between
    const put = (kind, order, parts) => {
      const before = sums[kind][order] || NONE;
      sums[kind][order] = parts.map((part, way) => addWithoutRounding(before[way], part));
    };
    for (const device of devices) {
      const square = (device.order * engine.omega) ** 2;
      const forward = scaled(device.forward, square);
      const backward = scaled(device.backward, square);
      put("force", device.order, [forward, backward]);
      put("moment", device.order, [forward, backward].map((force) => momentOf(engine, force, device.z)));
      const half = findCoupleOf(armOf(engine, device.at), forward, backward);
      put("couple", device.order, [half, conjugate(half)]);
      put("roll", device.order, [half, conjugate(half)]);
    }
    return { kinds: sums, peak: { force: findPeak(sums.force), moment: findPeak(sums.moment) } };
  }
  function addWithoutRounding(before, part) {
    const total = add(before, part);
    return size(total) <= 2e-11 * size(part) ? [0, 0] : total;   // as core/loads.py
  }

  // Forward phasor of the moment about the crank that a force a e^(inθ) + b e^(-inθ) makes at an arm:
  //   Im(conj(arm) F) = Re(c e^(inθ)) with c = -i (conj(arm) a - arm conj(b)); half of it turns forward
  function findCoupleOf(arm, forward, backward) {
    const ahead = times(conjugate(arm), forward);
    const behind = times(arm, conjugate(backward));
    const [x, y] = add(ahead, scaled(behind, -1));
    return [y / 2, -x / 2];
  }

  // ------------------------------------------------------------------ peaks
  const tables = new Map();
  // Cosines and sines of `count` even angles, made once.
  function findTable(count) {
    if (!tables.has(count)) {
      const angles = Array.from({ length: count }, (_, k) => TURN * k / count);
      tables.set(count, { cosines: angles.map(Math.cos), sines: angles.map(Math.sin) });
    }
    return tables.get(count);
  }

  // Orders of a quantity that are more than rounding: { n, a, b } with both phasors.
  function listTerms(phasors, least) {
    const sizes = phasors.map(([forward, backward]) => size(forward) + size(backward));
    const total = sum(sizes);
    const terms = [];
    phasors.forEach(([a, b], n) => { if (sizes[n] > least * total) terms.push({ n, a, b }); });
    return { terms, total };
  }

  // Vector and its first two derivatives at a crank angle.
  function differentiate(terms, theta) {
    let [x, y, x1, y1, x2, y2] = [0, 0, 0, 0, 0, 0];
    for (const { n, a, b } of terms) {
      const c = Math.cos(n * theta);
      const s = Math.sin(n * theta);
      const [ax, ay] = [a[0] * c - a[1] * s, a[0] * s + a[1] * c];
      const [bx, by] = [b[0] * c + b[1] * s, b[1] * c - b[0] * s];
      x += ax + bx;
      y += ay + by;
      x1 -= n * (ay - by);                                    // d/dθ a e^(inθ) = i n a e^(inθ)
      y1 += n * (ax - bx);
      x2 -= n * n * (ax + bx);
      y2 -= n * n * (ay + by);
    }
    return [[x, y], [x1, y1], [x2, y2]];
  }

  // Sizes of the vector at `count` even angles.
  function sampleSizes(terms, count) {
    const { cosines, sines } = findTable(count);
    const sizes = new Float64Array(count);
    for (let k = 0; k < count; k++) {
      let x = 0;
      let y = 0;
      for (const { n, a, b } of terms) {
        const at = n * k % count;
        x += (a[0] + b[0]) * cosines[at] + (b[1] - a[1]) * sines[at];
        y += (a[1] + b[1]) * cosines[at] + (a[0] - b[0]) * sines[at];
      }
      sizes[k] = Math.sqrt(x * x + y * y);
    }
    return sizes;
  }

  // The largest size of a vector over a revolution, and where it is first: Newton's method for the square p·p from the
  // highest of even angles, θ -= (p·p′) / (p′·p′ + p·p″).
  function findPeak(phasors, least = 1e-14) {
    const { terms, total } = listTerms(phasors, least);
    if (!terms.length) return { value: 0, theta: null };
    const count = 16 * Math.max(16, terms.at(-1).n);
    const step = TURN / count;
    const sizes = sampleSizes(terms, count);
    const most = largest(sizes);
    const tops = [];
    for (let k = 0; k < count; k++) {
      const isTop = sizes[k] >= sizes[(k + count - 1) % count] && sizes[k] >= sizes[(k + 1) % count];
      const isFirst = k === 0 && sizes[k] >= most * (1 - 1e-12);   // a constant size counts from 0
      if ((isTop && sizes[k] >= 0.98 * most) || isFirst) tops.push(climb(terms, step * k, step));
    }
    const top = largest(tops.map(({ value }) => value));
    const highest = tops.filter(({ value }) => value >= top - 1e-12 * total);
    return highest.sort((a, b) => a.theta - b.theta)[0];
  }
  function climb(terms, start, step) {
    let theta = start;
    for (let round = 0; round < 8; round++) {
      const [p, d1, d2] = differentiate(terms, theta);
      const curvature = dot(d1, d1) + dot(p, d2);
      if (curvature >= 0) continue;
      theta -= Math.max(-step, Math.min(step, dot(p, d1) / curvature));
    }
    const at = (theta % TURN + TURN) % TURN;
    return { value: size(differentiate(terms, theta)[0]), theta: TURN - at < 1e-6 ? 0 : at };
  }

  // ------------------------------------------------------------------ main bearings
  // Bearings, each with the phasors of its load by the cylinders and counterweights next to it (lever rule).
  function findBearings(engine, samples) {
    const all = placeBearings(engine);
    const shares = engine.cylinders.map(({ z }) => shareLoad(all, z));
    return all.map((_, bearing) => {
      const carry = (z) => shareLoad(all, z)[bearing];
      const own = shares.map((ofCylinder) => ofCylinder[bearing]);
      const phasors = transform(addUp(samples, "x", own), addUp(samples, "y", own));
      return { carry, phasors: addWeights({ carry, phasors }, engine, engine.devices) };
    });
  }

  // Places of the bearings: those of the file, or half-way between throws and as far outside the end throws; none if
  // the throws stand in one plane, or their places are unknown.
  function placeBearings(engine) {
    if (engine.known && engine.bearings) return engine.bearings;
    const rounded = engine.throws.map(({ z }) => Math.round(z * 1e12) / 1e12);
    const places = [...new Set(rounded)].sort((a, b) => a - b);
    if (!engine.known || places.length < 2) return [];
    const between = places.slice(1).map((z, k) => (z + places[k]) / 2);
    const start = 2 * places[0] - between[0];
    const end = 2 * places.at(-1) - between.at(-1);
    return [start, ...between, end];
  }

  // Shares of a load at z that each bearing carries: the two beside it, by the lever rule.
  function shareLoad(bearings, z) {
    const before = bearings.findLastIndex((at) => at <= z);
    const left = Math.min(Math.max(before, 0), bearings.length - 2);
    const right = (z - bearings[left]) / (bearings[left + 1] - bearings[left]);
    const shares = bearings.map(() => 0);
    shares[left] = 1 - right;
    shares[left + 1] = right;
    return shares;
  }

  // Phasors of a bearing's load with counterweights, which change order 1 alone.
  function addWeights({ carry, phasors }, { omega }, devices) {
    const sums = phasors.slice();
    for (const device of devices.filter(isCounterweight)) {
      const [forward, backward] = sums[1];
      sums[1] = [add(forward, scaled(device.forward, carry(device.z) * omega ** 2)), backward];
    }
    return sums;
  }

  // The largest load of a bearing over a revolution, with further counterweights; null without bearings.
  function findMainLoad(engine, bearings, devices) {
    if (!bearings.length) return null;
    return largest(bearings.map((bearing) => findPeak(addWeights(bearing, engine, devices), 1e-11).value));
  }

  // ------------------------------------------------------------------ the ladder
  // A part is small if it is 0 or below a limit; a part of just this size is not small.
  const isSmall = (value, least) => !value || value < least * (1 - 1e-9);

  // Force F1 and moment M1 of one cylinder's first order: F1 = m_rec r ω², M1 = F1 L with the length L of the engine.
  function findScale({ cylinders, r, omega }) {
    const places = cylinders.map(({ z }) => z);
    const length = Math.max(Math.max(...places) - Math.min(...places), 2 * r);
    const force = largest(cylinders.map((cylinder) => cylinder.reciprocating * cylinder.r)) * omega ** 2;
    return { force, moment: force * length, length };
  }

  // Force and moment of an order that turn in one direction (sense 1 or -1). The moment is that of the force times its
  // distance, Σ z F = -i M; [0, 0] if unknown.
  function findPart(engine, kinds, order, sense) {
    const way = sense > 0 ? 0 : 1;
    const force = kinds.force[order][way];
    const [x, y] = kinds.moment[order][way];
    return { order, sense, force, moment: engine.known ? [y, -x] : [0, 0] };
  }
  const shareOf = ({ scale }, { force, moment }) => {
    const ofForce = size(force) && size(force) / scale.force;
    const ofMoment = size(moment) && size(moment) / scale.moment;
    return Math.max(ofForce, ofMoment);
  };

  // What a step cancels: its largest rotating force and moment, and the larger of both as a share of one cylinder's.
  function measure(ladder, parts) {
    return {
      force: largest(parts.map(({ force }) => size(force))),
      moment: largest(parts.map(({ moment }) => size(moment))),
      share: largest(parts.map((part) => shareOf(ladder, part))),
    };
  }

  // Devices that balance the engine step by step. `limits` are those of the command: small, shown, rounding, and
  // from which share of one cylinder's first order a shaft is worth fitting.
  function findLadder(engine, limits) {
    const drawn = compute(engine);
    const scale = findScale(engine);
    const bearings = findBearings(engine, drawn.samples);
    const makeStep = (step, devices) => ({
      step,
      devices,
      ...addDevices(engine, drawn.kinds, devices),
      mainLoad: findMainLoad(engine, bearings, devices),
    });
    const steps = [makeStep("as drawn", [])];
    const ladder = { engine, limits, drawn, scale, makeStep, steps };
    const leftOut = [];
    let listed = [];
    const consider = (offer) => {
      if (!offer.listed) {
        leftOut.push(offer);
        return;
      }
      if (offer.step === AT_THROWS) listed = [];              // these replace those in the end planes
      listed.push(offer);
      const devices = listed.flatMap(({ own }) => own);
      steps.push({ ...offer, ...makeStep(offer.step, devices) });
    };
    consider(offerWeights(ladder));
    offerWeightsAtThrows(ladder, listed).forEach(consider);
    const others = engine.crossheads ? offerCompensators(ladder) : offerShafts(ladder);
    others.forEach(consider);
    const isReplaced = ({ step }) => step === WEIGHTS && steps.some((each) => each.step === AT_THROWS);
    const matters = ({ cancels, own }) => cancels.share || own.length;
    return {
      steps,
      scale,
      drawn,
      makeStep,
      auto: chooseUsual(steps.filter((step) => !isReplaced(step))),
      leftOut: leftOut.filter((offer) => matters(offer) && !isReplaced(offer)),
    };
  }

  // Names of the steps that are fitted by default. If counterweights would take back those of the file, order 1 stays.
  function chooseUsual(steps) {
    const settled = steps.some(({ takesBack }) => takesBack);
    const usual = steps.filter(({ order, worthIt }) => worthIt && !(settled && order === 1));
    return usual.map(({ step }) => step);
  }

  function offerWeights(ladder) {
    const { engine, limits, drawn } = ladder;
    const part = findPart(engine, drawn.kinds, 1, 1);
    const cancels = measure(ladder, [part]);
    const listed = !isSmall(cancels.share, limits.small);
    const own = listed ? cancel(ladder, part) : [];
    const [ahead, against] = drawn.kinds.moment[1].map(size);
    return {
      step: WEIGHTS,
      order: 1,
      listed,
      own,
      cancels,
      worthIt: !engine.crossheads || isLikely(ladder, ahead + against),
      takesBack: takesBack(ladder, own),
    };
  }

  // The step with a counterweight at every throw, if the crank has throws in three or more planes.
  function offerWeightsAtThrows(ladder, listed) {
    const { engine, limits, scale, makeStep, steps } = ladder;
    const planes = new Set(engine.throws.map(({ z }) => z));
    const load = steps.at(-1).mainLoad;
    if (load === null || planes.size < 3) return [];
    const own = placeAtThrows(ladder);
    const fall = load - makeStep(AT_THROWS, own).mainLoad;
    const relieves = fall > limits.rounding * load && !isSmall(fall, limits.small * scale.force);
    const parts = listed.length ? [] : [findPart(engine, ladder.drawn.kinds, 1, 1)];
    return [{
      step: AT_THROWS,
      order: 1,
      listed: relieves && !engine.crossheads,
      own,
      cancels: measure(ladder, parts),
      fall,
      worthIt: true,
      takesBack: takesBack(ladder, own),
    }];
  }

  // A counterweight at each throw against the force of its cylinders that turns with the crank, less the file's
  // counterweights at the nearest throw. The smallest additions a + b (z - mean z) at the throws cancel what is left of
  // force f and moment m:  a = -f / n,  b = -(m - mean z f) / Σ (z - mean z)².
  function placeAtThrows(ladder) {
    const { engine, drawn } = ladder;
    const square = engine.omega ** 2;
    const reference = engine.reference[2];
    const places = engine.throws.map(({ z }) => z);
    const weights = opposeThrows(engine, drawn.ofCylinders);
    const { force, moment } = findPart(engine, drawn.kinds, 1, 1);
    const f = add(addAll(weights), scaled(force, 1 / square));
    const moments = weights.map((weight, k) => scaled(weight, places[k] - reference));
    const m = add(addAll(moments), scaled(moment, 1 / square));
    const total = sumMovingMasses(engine);
    if (size(f) > 1e-13 * total || size(m) > 1e-13 * total * ladder.scale.length) {
      const middle = sum(places) / places.length;
      const spread = sum(places.map((z) => (z - middle) ** 2));
      const shift = scaled(f, -1 / places.length);
      const tilt = scaled(add(m, scaled(f, reference - middle)), -1 / spread);
      places.forEach((z, k) => {
        const addition = add(shift, scaled(tilt, z - middle));
        weights[k] = add(weights[k], addition);
      });
    }
    return makeWeights(ladder, weights.map((weight, k) => ({ weight, z: places[k] })));
  }

  // The unbalance (kg m) that each throw needs beside the counterweights of the file.
  function opposeThrows(engine, ofCylinders) {
    const square = engine.omega ** 2;
    const weights = engine.throws.map(() => [0, 0]);
    engine.cylinders.forEach((cylinder, row) => {
      const [forward] = ofCylinders[row][1];
      const at = engine.throws.findIndex(({ files }) => files.includes(cylinder.throw));
      weights[at] = add(weights[at], scaled(forward, -1 / square));
    });
    for (const device of engine.devices.filter(isCounterweight)) {
      const distances = engine.throws.map(({ z }) => Math.abs(z - device.z));
      const nearest = distances.indexOf(Math.min(...distances));
      weights[nearest] = add(weights[nearest], scaled(device.forward, -1));
    }
    return weights;
  }
  const sumMovingMasses = ({ cylinders }) => sum(cylinders.map((c) => (c.reciprocating + c.rotating) * c.r));

  // Counterweights of these unbalances, without those that are rounding.
  function makeWeights({ engine, limits }, placed) {
    const least = limits.rounding * sumMovingMasses(engine);
    const due = placed.filter(({ weight }) => size(weight) > least);
    return due.map(({ weight, z }) => makeDevice({ kind: "counterweight", U: size(weight), angle: angleOf(weight), z }));
  }

  // Whether new counterweights work against those of the file, in force and moment together.
  function takesBack({ engine, scale }, own) {
    const ofFile = engine.devices.filter(isCounterweight);
    const compare = (armOfDevice) => {
      const total = (devices) => addAll(devices.map((device) => scaled(device.forward, armOfDevice(device))));
      return dot(total(ofFile), total(own));
    };
    const ofForce = compare(() => 1);
    const ofMoment = engine.known ? compare(({ z }) => z - engine.reference[2]) / scale.length ** 2 : 0;
    const sizes = sum(ofFile.map(({ U }) => U)) * sum(own.map(({ U }) => U));
    return ofForce + ofMoment < -1e-9 * sizes;
  }

  // The steps with shafts for order 1, against the crank, and for order 2.
  function offerShafts(ladder) {
    const { limits, engine } = ladder;
    const counted = Math.max(engine.cylinders.length, limits.fewest);
    return [
      ...offerShaftsOf(ladder, { order: 1, senses: [-1], limit: limits.worth1 }),
      ...offerShaftsOf(ladder, { order: 2, senses: [1, -1], limit: limits.worth2 * counted }),
    ];
  }
  function offerShaftsOf(ladder, { order, senses, limit }) {
    const { engine, limits, drawn } = ladder;
    const parts = senses.map((sense) => findPart(engine, drawn.kinds, order, sense));
    const due = parts.filter((part) => !isSmall(shareOf(ladder, part), limits.small));
    const named = due.length ? due : parts.filter((part) => shareOf(ladder, part));
    if (!named.length) return [];
    const single = `shaft at ${named[0].sense > 0 ? "+" : "-"}${order}`;
    const share = largest(parts.map((part) => shareOf(ladder, part)));
    return [{
      step: named.length > 1 ? "shafts at +2 and -2" : single,
      order,
      listed: due.length > 0,
      own: due.flatMap((part) => cancel(ladder, part)),
      cancels: measure(ladder, named),
      worthIt: !isSmall(share, limit),
    }];
  }

  // The steps with pairs of masses at both ends, for the moment about y that counterweights leave.
  function offerCompensators(ladder) {
    const { engine, limits, scale, steps } = ladder;
    const orders = engine.known ? [1, 2] : [];
    return orders.map((order) => {
      const { kinds } = steps.at(-1);
      const ahead = findPart(engine, kinds, order, 1).moment;
      const against = findPart(engine, kinds, order, -1).moment;
      const turning = add(ahead, conjugate(against));         // amplitude along x of what both make
      const moment = size(turning) > limits.rounding * scale.moment ? size(turning) : 0;
      const listed = !isSmall(moment / scale.moment, limits.small);
      return {
        step: `compensators of order ${order}`,
        order,
        listed,
        own: listed ? compensate(engine, order, turning) : [],
        cancels: { force: 0, moment, share: moment && moment / scale.moment },
        worthIt: isLikely(ladder, moment),
      };
    });
  }
  // Whether the power related unbalance of a moment, N m/kW, makes compensators likely; not without a known power.
  const isLikely = ({ engine, limits }, moment) => engine.power > 0 && moment / engine.power > limits.likely;

  // The end planes: the first and the last throw; for throws in one plane, half a bore on either side of it.
  function findEnds(engine) {
    const places = engine.throws.map(({ z }) => z);
    const low = Math.min(...places);
    const high = Math.max(...places);
    const half = engine.bore / 2 || engine.r;
    return low === high ? [low - half, high + half] : [low, high];
  }

  // Pairs of equal masses in the end planes that turn in opposite directions: their forces along x cancel a moment
  // about y. A pair of U/2 makes the force U (nω)² cos(nθ + a).
  function compensate(engine, order, moment) {
    const [low, high] = findEnds(engine);
    const unbalance = scaled(moment, 1 / (high - low) / (order * engine.omega) ** 2);
    const half = size(unbalance) / 2;
    const ends = [{ z: low, angle: angleOf(unbalance) }, { z: high, angle: angleOf(unbalance) + TURN / 2 }];
    const make = (sense, { z, angle }) =>
      makeDevice({ kind: "shaft", U: half, angle: sense * angle, z, ratio: sense * order });
    return ends.flatMap((end) => [make(1, end), make(-1, end)]);
  }

  // Devices that cancel a rotating force f and moment m. A shaft alone suffices at z_ref + m/f if m is parallel to f;
  // otherwise two devices at the ends: upper (z_high - z_low) = -(m + f (z_ref - z_low)) / (nω)².
  function cancel(ladder, { order, sense, force, moment }) {
    const { engine } = ladder;
    const onCrank = order * sense === 1;
    const perForce = -1 / (order * engine.omega) ** 2;
    const makeShaft = (vector, z) =>
      makeDevice({ kind: "shaft", U: size(vector), angle: angleOf(vector), z, ratio: sense * order });
    const alone = onCrank ? null : findPlaceAlone(ladder, force, moment);
    if (alone !== null) return [makeShaft(scaled(force, perForce), alone)];
    const [low, high] = findEnds(engine);
    const aboutLow = add(moment, scaled(force, engine.reference[2] - low));
    const upper = scaled(aboutLow, perForce / (high - low));
    const lower = add(scaled(force, perForce), scaled(upper, -1));
    const pair = [{ weight: lower, z: low }, { weight: upper, z: high }];
    if (onCrank) return makeWeights(ladder, pair);
    const due = pair.filter(({ weight }) => size(weight) > 0);
    return due.map(({ weight, z }) => makeShaft(weight, z));
  }

  // Where a single device cancels a force and its moment, within the engine; null if it cannot.
  function findPlaceAlone({ engine, scale }, force, moment) {
    if (!size(force)) return null;
    const reference = engine.reference[2];
    const places = [...engine.throws, ...engine.cylinders].map(({ z }) => z);
    const wanted = reference + dot(moment, force) / size(force) ** 2;
    const z = Math.min(Math.max(wanted, Math.min(...places)), Math.max(...places));
    const left = add(moment, scaled(force, reference - z));
    const rounding = 1e-11 * (size(moment) + size(force) * scale.length);
    return size(left) <= rounding ? z : null;
  }

  // ------------------------------------------------------------------ the verdict
  // Orders that the command shows: 1, 2, those of gas, and those in which some kind exceeds a share of its largest
  // amplitude.
  function listShown(engine, ladder, { shown }) {
    const orders = new Set([1, 2, ...engine.gasOrders]);
    for (const [kind, phasors] of Object.entries(ladder.drawn.kinds)) {
      if (kind === "moment" && !engine.known) continue;
      const sizes = Object.entries(phasors).map(([n, [a, b]]) => ({ n: Number(n), amplitude: size(a) + size(b) }));
      const most = largest(sizes.map(({ amplitude }) => amplitude));
      for (const { n, amplitude } of sizes) {
        if (n && amplitude > shown * most) orders.add(n);
      }
    }
    return [...orders].sort((a, b) => a - b);
  }

  // Which of force and moment of an order are large (their largest value is not small), and a device for each direction
  // in which a vector turns that is not small by itself; as `analysis.verdict` finds them.
  function judgeOrder(engine, ladder, limits, order) {
    const { drawn: { kinds }, scale } = ladder;
    const large = [];
    const due = new Set();
    for (const kind of engine.known ? ["force", "moment"] : ["force"]) {
      const [forward, backward] = (kinds[kind][order] || NONE).map(size);
      const least = limits.small * scale[kind];
      if (!isSmall(forward, least)) due.add(1);
      if (!isSmall(backward, least)) due.add(-1);
      if (!isSmall(forward + backward, least)) large.push(kind);
    }
    if (engine.crossheads && order <= 2) return { order, large };   // compensators take the place of shafts
    const ratios = [order, -order].filter((ratio) => due.has(Math.sign(ratio)));
    return { order, large, cures: ratios.map((ratio) => nameCure(engine, { ...ladder, engine, limits }, ratio)) };
  }
  function nameCure(engine, ladder, ratio) {
    const order = Math.abs(ratio);
    const turns = (device) => size(ratio > 0 ? device.forward : device.backward) > 0;
    const isAlike = (device) => device.kind !== "slider" && device.order === order && turns(device);
    const cure = { ratio, on_crank: ratio === 1, further: engine.devices.some(isAlike) };
    if (ratio !== 1) return cure;
    const weights = cancel(ladder, findPart(engine, ladder.drawn.kinds, 1, 1));
    return takesBack(ladder, weights) ? { ...cure, takes_back: true } : cure;
  }
  function judge(engine, ladder, limits, shown) {
    const findings = shown.map((order) => judgeOrder(engine, ladder, limits, order));
    return findings.filter(({ large }) => large.length);
  }

  // The order of the largest couple among these, and what causes the couple; null if it is worth naming in none of them.
  function judgeCouple(engine, { drawn, scale }, { worthNaming }, shown) {
    const sizeOf = (n) => 2 * size((drawn.kinds.couple[n] || NONE)[0]);
    const least = worthNaming * scale.force * engine.r;
    const orders = shown.filter((n) => !isSmall(sizeOf(n), least));
    if (!orders.length) return null;
    const order = orders.reduce((most, n) => sizeOf(n) > sizeOf(most) ? n : most);
    return { order, causes: findCauses(engine, drawn, orders, least) };
  }

  // Which causes change the couple in these orders: rods, then offset pistons, then lines of force that miss the
  // reference point.
  function findCauses(engine, { kinds, samples }, orders, least) {
    const list = (values) => transform(values).map(([forward]) => forward);
    const balanced = kinds.couple.map(() => [0, 0]);
    const rods = addUp(samples, "rod");
    const pistons = addUp(samples, "offset");
    const ofRods = list(rods);
    const withOffsets = list(rods.map((value, k) => value + pistons[k]));
    const whole = kinds.couple.map(([forward]) => forward);
    const differ = (from, to) => orders.some((n) => 2 * size(add(to[n], scaled(from[n], -1))) > least);
    const causes = [];
    if (differ(balanced, ofRods)) causes.push("rods");
    if (differ(ofRods, withOffsets)) causes.push("offset_pistons");
    if (differ(withOffsets, whole)) causes.push("reference_point");
    return causes;
  }

  // ------------------------------------------------------------------ the document
  // Crank angle (deg) of the first positive peak of Re(c e^(inθ)).
  function findFirstPeak(c, n) {
    const at = wrapDeg(deg(-angleOf(c))) / n;
    return at < 360 / n ? at : 0;
  }

  // A vector a e^(inθ) + b e^(-inθ): an ellipse with the semi-axes |a| + |b| and ||a| - |b||, its axis at (arg a + arg b)/2.
  // Its components along x and y, and along `words` if the file says which way is `up`.
  function describeVector([a, b], n, words = [], up = 0) {
    const major = size(a) + size(b);
    const [x, y] = describeComponents(a, b, n);
    const turned = describeComponents(times(a, polar(1, rad(-up))), times(b, polar(1, rad(-up))), n);
    return {
      forward: a,
      backward: b,
      major,
      minor: n ? Math.abs(size(a) - size(b)) : 0,
      axis_deg: findAxis(a, b, n),
      x,
      y,
      balanced: !major,
      ...Object.fromEntries(words.map((word, k) => [word, turned[k]])),
    };
  }
  function findAxis(a, b, n) {
    if (!n) return size(a) ? deg(angleOf(a)) : null;          // order 0 is a constant vector
    if (!size(a) || !size(b)) return null;                    // a circle
    const axis = deg(angleOf(a) + angleOf(b)) / 2;
    return 90 - ((90 - axis) % 180 + 180 + 1e-6) % 180 + 1e-6;   // in (-90, 90]
  }
  // x = Re((a + conj b) e^(inθ)), y = Re(-i (a - conj b) e^(inθ))
  function describeComponents(a, b, n) {
    const describe = (c) => ({ amplitude: size(c), phase_deg: n && size(c) ? deg(-angleOf(c)) : null });
    const ofX = add(a, conjugate(b));
    const ofY = [a[1] + b[1], b[0] - a[0]];
    return [describe(ofX), describe(ofY)];
  }
  function describeScalar([forward], n) {
    const c = scaled(forward, n ? 2 : 1);
    const amplitude = size(c);
    return { cos: c[0], sin: -c[1] || 0, amplitude, peak_deg: n && amplitude ? findFirstPeak(c, n) : null, balanced: !amplitude };
  }
  function describePeak({ force, moment }) {
    const inDeg = (theta) => theta === null ? null : deg(theta);
    return {
      force_N: force.value,
      force_deg: inDeg(force.theta),
      moment_Nm: moment.value,
      moment_deg: inDeg(moment.theta),
    };
  }

  // A device as the command describes it, with its vectors (kg m). A shaft that makes only a moment is free.
  function describeDevice(engine, device, devices) {
    const onCrank = isCounterweight(device);
    const { kind, ratio, order, U, forward, backward } = device;
    return {
      device: kind,
      ...(onCrank ? {} : { ratio, free: isFree(device, devices) }),
      at_mm: device.at.map((metres) => 1e3 * metres),
      unbalance_kg_m: U,
      angle_deg: wrapToHalfTurn(deg(device.angle - (onCrank ? engine.firstAxis : 0))),
      position_mm: 1e3 * device.z,
      kind,
      order,
      forward,
      backward,
    };
  }
  function wrapToHalfTurn(angle) {                            // to -180 … 180
    const turned = angle % 360;
    if (turned <= -180) return turned + 360;
    return turned > 180 ? turned - 360 : turned;
  }
  function isFree({ kind, ratio }, devices) {
    const same = devices.filter((other) => other.kind === kind && other.ratio === ratio);
    const total = addAll(same.map(({ forward, backward }) => add(forward, backward)));
    return same.length > 1 && size(total) <= 1e-10 * largest(same.map(({ U }) => U));
  }

  // Force and moment of the orders that devices change.
  function listChanges(devices, kinds) {
    const orders = new Set(devices.map(({ order }) => order));
    const sorted = [...orders].sort((a, b) => a - b);
    return sorted.map((order) => ({ order, force: kinds.force[order] || NONE, moment: kinds.moment[order] || NONE }));
  }
  function describeStep(engine, { step, devices, peak, kinds, mainLoad, takesBack }) {
    const shafts = devices.filter(({ kind }) => kind === "shaft");
    const steel = weighSteel(engine, devices);
    return {
      step,
      ...(takesBack ? { takes_back: true } : {}),
      peak_force_N: peak.force.value,
      ...(engine.known ? { peak_moment_Nm: peak.moment.value } : {}),
      ...(mainLoad === null ? {} : { main_bearing_N: mainLoad }),
      counterweights: devices.filter(isCounterweight).length,
      shafts: new Set(shafts.map(({ ratio }) => ratio)).size,
      mass_kg: sum(devices.map(({ U }) => U)) / engine.r,
      ...(steel === null ? {} : { steel_kg: steel }),
      devices: devices.map((device) => describeDevice(engine, device, devices)),
      changes: listChanges(devices, kinds),
    };
  }
  // Mass of half discs of steel; null if the room around the crank is not known.
  //   counterweight with the radius R of this room   m = 3π U / (4 R)
  //   eccentric of a shaft, as long as its diameter  m = π ρ (3 U / (4 ρ))^(3/4)
  function weighSteel(engine, devices) {
    const radius = findRoom(engine);
    if (radius <= 0 && devices.some(isCounterweight)) return null;
    const masses = devices.map((device) => isCounterweight(device)
      ? 3 * Math.PI * device.U / (4 * radius)
      : Math.PI * STEEL * (0.75 * device.U / STEEL) ** 0.75);
    return sum(masses);
  }
  // Radius of the room around the crank, below the lowest piston: its pin is at √((l - r)² - e²).
  function findRoom({ cylinders, skirt, crankcase }) {
    const distance = Math.min(...cylinders.map(({ l, r, e }) => Math.sqrt((l - r) ** 2 - e ** 2)));
    const belowPistons = skirt === null ? SHARE_OF_DISTANCE * distance : distance - skirt;
    return Math.min(crankcase, belowPistons);
  }
  function describeLeftOut(engine, { step, cancels, fall }) {
    return {
      step,
      force_N: cancels.force,
      ...(engine.known ? { moment_Nm: cancels.moment } : {}),
      ...(fall === undefined ? {} : { main_bearing_N: fall }),
    };
  }

  // The steps that are fitted by default, if they are not those of a row.
  function describeUsual(engine, { steps, auto, makeStep }) {
    const isRow = steps.some((_, k) => String(listStepsOfRow(steps, k)) === String(auto));
    if (isRow) return [];
    const chosen = steps.filter(({ step }) => auto.includes(step));
    const numbers = chosen.map((each) => steps.indexOf(each));
    const named = numbers.length === 1 ? `step ${numbers[0]} alone` : `steps ${numbers.join(" and ")}`;
    const made = makeStep(`default: ${named}`, chosen.flatMap(({ own }) => own));
    return [describeStep(engine, { ...made, takesBack: false })];
  }
  // Names of the steps whose devices a row of the ladder has.
  function listStepsOfRow(steps, row) {
    const names = steps.slice(1, row + 1).map(({ step }) => step);
    return names.includes(AT_THROWS) ? names.filter((step) => step !== WEIGHTS) : names;
  }

  // Vectors of the cylinders by order and direction of rotation, at crank angle 0, with the sums of banks. If each
  // cylinder is a bank of its own, the banks are one group.
  function describeStars(engine, { drawn }, orders) {
    const banks = [...new Set(engine.cylinders.map(({ bank }) => bank))];
    const isRadial = banks.length > 2 && banks.length === engine.cylinders.length;
    const bounds = findBounds(engine);
    const phasors = drawn.ofCylinders;
    const stars = [];
    for (const order of orders.filter((n) => n > 0)) {
      for (const [way, turns] of ["forward", "backward"].entries()) {
        const rays = engine.cylinders.map((cylinder, row) => {
          const force = drop((phasors[row][order] || NONE)[way], bounds.force);
          return { cylinder, force, moment: momentOf(engine, force, cylinder.z) };
        });
        if (!rays.some(({ force }) => size(force))) continue;
        const groups = isRadial ? [rays] : banks.map((bank) => rays.filter(({ cylinder }) => cylinder.bank === bank));
        const described = groups.map((group) => describeBank(engine, group, isRadial, bounds));
        stars.push({ order, turns, ...describeSum(engine, rays, bounds), banks: described });
        if (stars.length === MOST_STARS) return stars;
      }
    }
    return stars;
  }
  function describeBank(engine, rays, isRadial, bounds) {
    const cylinders = rays.map(({ cylinder, force, moment }) => ({ cylinder: cylinder.number, ...describeRay(engine, force, moment) }));
    return {
      axis_deg: isRadial ? null : deg(rays[0].cylinder.axis),
      ...describeSum(engine, rays, bounds),
      cylinders: cylinders.sort((a, b) => a.cylinder - b.cylinder),
    };
  }
  function describeSum(engine, rays, bounds) {
    const force = drop(addAll(rays.map((ray) => ray.force)), bounds.force);
    const moment = drop(addAll(rays.map((ray) => ray.moment)), bounds.moment);
    return describeRay(engine, force, moment);
  }
  function describeRay(engine, force, moment) {
    const direction = (vector) => size(vector) ? wrapDeg(deg(angleOf(vector))) : null;
    const ofForce = { force_N: size(force), force_deg: direction(force) };
    return engine.known ? { ...ofForce, moment_Nm: size(moment), moment_deg: direction(moment) } : ofForce;
  }

  // After which angle the size of a vector repeats, deg; 0 if it is constant. Its vectors turn at the speeds ±n; the
  // greatest common divisor of their differences counts the repeats in a revolution.
  function findRepeat(phasors) {
    const speeds = [];
    phasors.forEach(([forward, backward], n) => {
      if (size(forward)) speeds.push(n);
      if (size(backward)) speeds.push(-n);
    });
    const differences = speeds.map((speed) => Math.abs(speed - speeds[0]));
    const repeats = differences.reduce(findDivisor, 0);
    return repeats ? 360 / repeats : 0;
  }
  const findDivisor = (a, b) => b ? findDivisor(b, a % b) : a;

  // Orders, verdict, peaks, ladder and stars as in the output of `balcli analyze --why -f json`; under "page" what only
  // the page needs.
  function describe(engine, ladder, limits, orders = null) {
    const { kinds, peak } = ladder.drawn;
    const { known } = engine;
    const shown = listShown(engine, ladder, limits);
    const couple = judgeCouple(engine, ladder, limits, shown);
    const roll = ladder.scale.force * engine.r;
    return {
      format: "balcli.analysis/1",
      speed_rpm: engine.omega * 60 / TURN,
      reference_mm: engine.reference.map((metres) => 1e3 * metres),
      orders: (orders || shown).map((order) => describeOrder(engine, kinds, order)),
      verdict: { matter: judge(engine, ladder, limits, shown), ...(couple ? { couple } : {}) },
      peak: describePeak(peak),
      ladder: {
        scale: { force_N: ladder.scale.force, ...(known ? { moment_Nm: ladder.scale.moment } : {}) },
        auto: ladder.auto,
        steps: ladder.steps.map((step) => describeStep(engine, step)),
        left_out: ladder.leftOut.map((offer) => describeLeftOut(engine, offer)),
      },
      stars: describeStars(engine, ladder, shown),
      page: {
        extra: describeUsual(engine, ladder),
        crossheads: engine.crossheads,
        scales: { moment_Nm: ladder.scale.moment, roll_Nm: roll },
        every: { force: findRepeat(kinds.force), moment: findRepeat(kinds.moment) },
        devices: engine.devices.map((device) => describeDevice(engine, device, engine.devices)),
        roll: describeRoll(kinds.roll),
      },
    };
  }
  // The largest roll over a revolution.
  function describeRoll(phasors) {
    const { value, theta } = findPeak(phasors);
    return { value_Nm: value, deg: theta === null ? null : deg(theta) };
  }
  function describeOrder({ up }, kinds, order) {
    const vector = (kind) => describeVector(kinds[kind][order] || NONE, order, up === null ? [] : UPRIGHT[kind], up);
    const scalar = (kind) => describeScalar(kinds[kind][order] || NONE, order);
    return {
      order,
      force_N: vector("force"),
      moment_Nm: vector("moment"),
      couple_Nm: scalar("couple"),
      inertia_torque_Nm: scalar("torque"),
      roll_Nm: scalar("roll"),
    };
  }

  return { assemble, compute, findLadder, describe, listShown };
})();
