// Units a person reads: mm and kN, not 1e-3 m and 1e3 N.

const prefixes = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n'], [1e-12, 'p']];
const scalable = new Set(['m', 's', 'N', 'Pa', 'J', 'm/s', 'm/s2', 'N s', 'W']);

const pretty = (unit) => unit.replace(/m\/s2/g, 'm/s²').replace(/\^2/g, '²').replace(/m3/g, 'm³').replace(/ s$/, '·s');

/** { factor, label }: value * factor is in `label`, for values up to `largest`. A density becomes one of the scaled unit. */
export function scaled(unit, largest) {
  const [, root] = /^\((.+)\)\^2\/Hz$/.exec(unit) ?? [];
  if (root) {
    const { factor, label } = scaled(root, Math.sqrt(largest));
    return { factor: factor * factor, label: `(${label})²/Hz` };
  }
  if (unit === '1' || unit === '') return { factor: 1, label: '' };
  if (!scalable.has(unit) || !(largest > 0)) return { factor: 1, label: pretty(unit) };
  const [size, prefix] = prefixes.find(([candidate]) => largest >= candidate) ?? [1, ''];
  return { factor: 1 / size, label: prefix + pretty(unit) };
}

export function largest(values) {
  let result = 0;
  for (const value of values) if (Math.abs(value) > result && Number.isFinite(value)) result = Math.abs(value);
  return result;
}

/** A number to `digits` significant digits, without needless zeros. */
export function short(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split('e');
    return `${+mantissa}·10${superscript(+exponent)}`;
  }
  return String(+value.toPrecision(digits)).replace('-', '−');
}

const superscript = (n) => String(n).replace(/-/, '⁻').replace(/\d/g, (d) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[d]);

/** "28.8 kN" */
export function withUnit(value, unit, digits = 4) {
  const { factor, label } = scaled(unit, Math.abs(value));
  return `${short(value * factor, digits)}${label ? ` ${label}` : ''}`;
}

/** "rail_displacement" as words. */
export const words = (name) => name.replace(/_/g, ' ');
