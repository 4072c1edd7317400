"use strict";
// Numbers of an engine file: their dotted names, and their values as people write them.
const Numbers = (() => {
  const DEVICE = /^(counterweight|shaft|slider)\.([1-9]\d*)(?:\.(.+))?$/;
  const OF_LIST = /^(?:counterweight|shaft|slider|cylinder)\.\d+/;
  const COMMA_IN_THOUSANDS = /^[-+]?\d{1,3},\d{3}(?!\d)/;
  //                     sign    decimal figure, not the top of a fraction           top     bottom      unit
  const WRITTEN = /^([-+]?)((?:(?!\d+\/\d)\d*\.?\d*(?:e[-+]?\d+)?)?)\+?(?:(\d+)\/(\d+))?\s*(.*)$/i;

  // The table of a number: "shaft.1" of "shaft.1.ratio", "rod" of "rod.length".
  const tableOf = (name) => name.match(OF_LIST)?.[0] ?? name.split(".")[0];
  // A number with the digits that a written file has.
  const brief = (value) => Number(value.toPrecision(12));

  // A unit in one spelling: "kg·mm²" and "kg mm^2" are "kgmm^2", and 3.5" are in.
  function spell(unit) {
    const word = unit.normalize("NFKC").replace(/["″“”]|''/, "in").replace("°", "deg").replace("μ", "u");
    const joined = word.replace(/([a-z])(?:\*\*)?([23])/gi, "$1^$2").replace(/[\s·⋅*]+|\.$/g, "");
    const isMega = joined.length < 2 || /^M[a-zG]/.test(joined);   // Mg: a megagram
    return isMega ? joined : joined.toLowerCase();
  }
  // A text with one spelling of signs and fractions: "3 ½" and "3-1/2" are "3+1/2".
  function spellFigure(text) {
    const apart = text.replace(/(\d?)\s*([¼-¾⅐-⅞])/, "$1 $2").normalize("NFKC").trim();
    return apart.replace("⁄", "/").replace(/^[−–]/, "-").replace(/^(\d+)[- ](\d+\/\d+)/, "$1+$2");
  }

  // The value of a text in the unit of the file; an Error says what would be right. `number` has unit and limits, `units`
  // the factors of other units by the unit of the file, and `limits` those of numbers without limits of their own.
  function read(name, text, number, units, limits) {
    const { unit } = number;
    const wanted = `give a number${unit ? ` in ${unit}` : ""}`;
    const plain = spellFigure(text);
    if (COMMA_IN_THOUSANDS.test(plain)) {
      throw new Error(`${name}: "${text}" can mean two numbers; write it without a comma`);
    }
    const [, sign, figure, top, bottom, word] = plain.replace(",", ".").match(WRITTEN) || [];
    const size = Number(figure || 0) + (top ? top / bottom : 0);
    if (!/\d/.test(figure + (top || "")) || !Number.isFinite(size)) {
      throw new Error(`${name}: "${text.slice(0, 40)}" is not a number; ${wanted}`);
    }
    const value = sign === "-" ? -size : size;
    const factor = findFactor(name, word, unit, units, wanted);
    return check(name, brief(value * factor), limits, number);
  }
  function findFactor(name, word, unit, units, wanted) {
    const isSame = (other) => spell(other) === spell(word);
    if (word === "" || isSame(unit)) return 1;
    const factors = Object.hasOwn(units, unit) ? units[unit] : {};
    const factor = factors[Object.keys(factors).find(isSame)];
    if (factor !== undefined) return factor;
    const others = Object.keys(factors).join(", ");
    const alternative = others && `, or in ${others}`;
    throw new Error(`${name}: the unit "${word.slice(0, 20)}" is not known here; ${wanted}${alternative}`);
  }
  function check(name, value, limits, { above, least = -limits.mostOfNumbers, most = limits.mostOfNumbers, whole }) {
    if (whole && (!Number.isInteger(value) || !value)) throw new Error(`${name}: give a whole number other than 0`);
    if (above !== undefined && value <= above) throw new Error(`${name}: ${value} is not above ${above}`);
    if (value < least) throw new Error(`${name}: ${value} is below ${least}`);
    if (value > most) throw new Error(`${name}: ${value} is above ${most}`);
    return value;
  }

  return { DEVICE, tableOf, brief, read };
})();
