// Which chart a table becomes, and in which section.
import { csv } from './decode.js';
import { chartFigure } from './charts.js';
import { dataTable, heatMap } from './grids.js';
import { largest, words } from './units.js';

const sections = [
  ['Track and seats', /^(history_seat_|wheel)/],
  ['Motion of sleeper and stones', /^history_/],
  ['Settlement under repeated load', /^settlement/],
  ['Pressure under the sleeper', /^pressure_/],
  ['Response of the layer, T(f,z)', /^(transfer|attenuation|modes_|displacement_)/],
  ['Contacts and energies', /^(contact|energies)/],
  ['Amplitude spectra', /^amplitude_/],
  ['Spectral densities (Welch)', /^density_/],
  ['Audit of the interface, computing time', /^(interface_audit|computing_time)/],
  ['Further records', /./],
];
const folded = new Set(['Amplitude spectra', 'Spectral densities (Welch)', 'Audit of the interface, computing time']);

const titles = [
  [/^history_seat_(.*)/, 'Rail seat “$1”'],
  [/^history_sensor_(.*)/, 'Sensor “$1”'],
  [/^history_(.*)/, '$1'],
  [/^amplitude_(?:seat_|sensor_)?(.*)/, 'Amplitudes, $1'],
  [/^density_(?:seat_|sensor_)?(.*)/, 'Density, $1'],
  [/^modes_(.*)/, 'Modes of $1'],
  [/^pressure_(.*)/, 'Pressure, $1'],
  [/^transfer$/, 'T(f,z), stone over sleeper'],
];

function title(name) {
  const [pattern, text] = titles.find(([candidate]) => candidate.test(name)) ?? [/^/, ''];
  return words(name.replace(pattern, text)).replace(/^./, (c) => c.toUpperCase());
}

/** "force on sleeper", "displacement x, y, z" */
function quantityOf(columns) {
  const names = columns.map((column) => words(column.name));
  const stems = [...new Set(names.map((name) => name.replace(/ [xyz]$/, '')))];
  return stems.length > 3 ? '' : stems.join(', ');
}

const withRun = (label, table, n) => (n > 1 ? `${label} · ${table.run}` : label);
const block = (table) => (table.block > 1 ? `Of ${table.rows} rows; each point is the largest magnitude of ${table.block}.` : '');

function csvOf(tables) {
  return () => tables.map((table) => (tables.length > 1 ? `# ${table.run}\n` : '') + csv(table.columns)).join('\n');
}

/** Columns of one unit, apart where they differ so much in size that one would be a line at zero. */
function bySize(columns) {
  const groups = [], most = columns[0].unit === '1' ? 1.3 : 2.5;  // decades
  for (const column of columns) {
    const size = largest(column.values);
    const group = groups.find((one) => size === 0 || one.size === 0 || Math.abs(Math.log10(size / one.size)) < most);
    if (group) group.columns.push(column), group.size = Math.max(group.size, size);
    else groups.push({ size, columns: [column] });
  }
  return groups.map((group) => group.columns);
}

/** One chart a unit and size; the same table of several runs overlaid. */
function lineCharts(tables, extra = {}) {
  const [first] = tables;
  const [x, ...rest] = first.columns;
  const units = [...new Set(rest.map((column) => column.unit))];
  const groups = units.flatMap((unit) => bySize(rest.filter((column) => column.unit === unit)));
  return groups.map((columns) => {
    const [{ unit }] = columns;
    const lines = tables.flatMap((table, run) => columns.flatMap((column, colour) => {
      const own = table.columns.find((candidate) => candidate.name === column.name);
      if (!own) return [];
      return [{ label: withRun(words(column.name), table, tables.length), x: table.columns[0].values, y: own.values, colour, run }];
    }));
    const quantity = quantityOf(columns);
    return chartFigure({ title: `${title(first.name)}${quantity ? `: ${quantity}` : ''}`, x, unit, quantity, lines, csv: csvOf(tables), note: block(first), ...extra });
  });
}

/** Mean of the stones of a bin with their standard deviation; coherence apart. */
function transferCharts(tables) {
  const [first] = tables;
  const bins = first.columns.filter((column) => /^bin_\d+$/.test(column.name)).map((column) => column.name);
  const lines = [], bands = [], coherence = [];
  tables.forEach((table, run) => bins.forEach((bin, colour) => {
    const column = (name) => table.columns.find((candidate) => candidate.name === name)?.values;
    const x = table.columns[0].values, mean = column(bin), spread = column(`${bin}_deviation`);
    if (!mean) return;
    const label = withRun(`${words(bin)}${bin === 'bin_1' ? ' (top)' : ''}`, table, tables.length);
    lines.push({ label, x, y: mean, colour, run });
    if (tables.length === 1) {
      lines.push({ label: `${label}, upper`, x, y: mean.map((m, i) => m + spread[i]), helper: true });
      lines.push({ label: `${label}, lower`, x, y: mean.map((m, i) => Math.max(m - spread[i], 0.1 * m)), helper: true });
      bands.push({ high: lines.length - 2, low: lines.length - 1, colour });
    }
    coherence.push({ label, x, y: column(`${bin}_coherence`), colour, run });
  }));
  const common = { x: first.columns[0], unit: '1', csv: csvOf(tables) };
  return [
    chartFigure({ ...common, title: 'T(f,z): stone over sleeper', quantity: 'T', lines, bands, logarithmic: true, note: 'Mean over the stones of a depth bin; the bands are one standard deviation up and down, not below a tenth of the mean.' }),
    chartFigure({ ...common, title: 'T(f,z): coherence', quantity: 'coherence', lines: coherence, note: 'Share of the power that follows the sleeper linearly; biased upwards with few averages.' }),
    ...lineCharts(tables.map((table) => ({ ...table, columns: table.columns.filter((column) => !/^bin_/.test(column.name)) })), { logarithmic: true }),
  ];
}

/** Every stone as a point over its distance from the sleeper. */
function fieldChart(tables) {
  const [first] = tables;
  const names = ['longitudinal', 'lateral', 'vertical'];
  const lines = tables.flatMap((table, run) => names.map((name, colour) => ({
    label: withRun(name, table, tables.length),
    x: table.columns.find((column) => column.name === 'distance').values,
    y: table.columns.find((column) => column.name === name).values,
    colour: colour + 3 * run,
  })));
  return [chartFigure({ title: 'Displacement of all stones at peak load', x: { name: 'distance', unit: 'm' }, unit: 'm', points: true, lines, csv: csvOf(tables), note: 'Over the distance from the bottom of the sleeper.' })];
}

function figuresOf(tables) {
  const { name } = tables[0];
  if (tables[0].columns[0].values.length === 0) return [];
  if (name === 'transfer') return transferCharts(tables);
  if (name === 'displacement_field') return fieldChart(tables);
  if (/^pressure_/.test(name)) return tables.flatMap((table) => ['at_peak_load', 'largest'].map((column) => heatMap(table, column, withRun(title(name), table, tables.length))));
  if (/^(modes_|transfer_bands|attenuation)/.test(name)) return tables.map((table) => dataTable(table, withRun(title(name), table, tables.length)));
  return lineCharts(tables, { logarithmic: /^(density|amplitude)_/.test(name) });
}

/** [{ heading, folded, figures: () => elements }] of the tables of all runs. */
export function chartSections(runs) {
  const byName = new Map();
  for (const run of runs) {
    for (const table of run.tables) byName.set(table.name, [...(byName.get(table.name) ?? []), table]);
  }
  const left = new Map(byName);
  return sections.flatMap(([heading, pattern]) => {
    const mine = [...left.values()].filter((tables) => pattern.test(tables[0].name));
    for (const tables of mine) left.delete(tables[0].name);
    return mine.length === 0 ? [] : [{ heading, folded: folded.has(heading), figures: () => mine.flatMap(figuresOf) }];
  });
}
