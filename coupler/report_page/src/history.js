// The history of a body that was picked.
import { chartFigure } from './charts.js';
import { csv, quantised } from './decode.js';
import { h } from './dom.js';
import { short } from './units.js';

const quantities = [
  ['displacement_x', 'm'], ['displacement_y', 'm'], ['displacement_z', 'm'],
  ['velocity_x', 'm/s'], ['velocity_y', 'm/s'], ['velocity_z', 'm/s'], ['von_mises_stress', 'Pa'],
];
const charts = [['displacement', [0, 1, 2]], ['velocity', [3, 4, 5]], ['largest von Mises stress', [6]]];

/** Elements for the body `index` of `part`; `time` of its history [s]. */
export function bodyHistory(part, index, time) {
  const body = part.bodies[index], name = `${body.kind} ${body.number}`;
  const columns = [{ name: 'time', unit: 's', values: time },
    ...part.histories[index].map((raw, q) => ({ name: quantities[q][0], unit: quantities[q][1], values: quantised(raw) }))];
  const place = body.centre.map((x) => short(x * 1e3, 4)).join(', ');
  return [
    h('p', { class: 'note' }, `${name}, centre of its surface at (${place}) mm at the start: x along the track, y from the track's centre, z up. Means over its surface.`),
    ...charts.map(([title, own]) => chartFigure({
      title: `${name}: ${title}`,
      x: columns[0],
      unit: quantities[own[0]][1],
      lines: own.map((q, colour) => ({ label: quantities[q][0].replace(/_/g, ' '), x: time, y: columns[q + 1].values, colour })),
      csv: () => csv(columns),
    })),
  ];
}
