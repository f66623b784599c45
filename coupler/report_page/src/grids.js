// Tables as tables, and maps of cells in colour.
import { csv } from './decode.js';
import { colours, css, isLight } from './colour_map.js';
import { button, fileName, h, saveCanvas, saveText, theme } from './dom.js';
import { largest, scaled, short, withUnit, words } from './units.js';

const mostColumns = 6;

/** A table of a few rows; one of many columns lies on its side. */
export function dataTable(table, title) {
  const cells = table.columns.map((column) => {
    const { factor, label } = scaled(column.unit, largest(column.values));
    return { name: `${words(column.name)}${label ? ` [${label}]` : ''}`, values: Array.from(column.values, (value) => short(value * factor)) };
  });
  const row = (children) => h('tr', {}, children);
  const upright = () => [
    h('thead', {}, row(cells.map(({ name }) => h('th', { scope: 'col' }, name)))),
    h('tbody', {}, cells[0].values.map((_, i) => row(cells.map(({ values }) => h('td', {}, values[i]))))),
  ];
  const lying = () => h('tbody', {}, cells.map(({ name, values }) => row([h('th', { scope: 'row' }, name), ...values.map((value) => h('td', {}, value))])));
  return h('figure', { class: 'chart' },
    h('figcaption', {}, h('span', { class: 'title' }, title),
      h('span', { class: 'tools' }, button('CSV', () => saveText(csv(table.columns), fileName(title, 'csv')), { 'aria-label': `Save ${title} as CSV` }))),
    h('div', { class: 'scroll', tabindex: '0' }, h('table', {}, cells.length > mostColumns ? lying() : upright())));
}

/** Pressure on the cells of a bottom: along the track to the right, across it upwards. */
export function heatMap(table, name, heading) {
  const column = (wanted) => table.columns.find((candidate) => candidate.name === wanted);
  const along = [...new Set(column('along').values)], across = [...new Set(column('across').values)];
  const { values, unit } = column(name);
  const top = Math.max(largest(values), 1e-300), scale = scaled(unit, top);
  const sum = values.reduce((a, b) => a + b, 0), mean = sum / values.length;
  const title = `${heading}: ${words(name)}`;
  const cell = 46, left = 64, above = 14, ratio = Math.max(2, Math.ceil(window.devicePixelRatio));
  const width = left + Math.max(300, cell * along.length) + 12, rows = across.length;
  const wide = (width - left - 12) / along.length, high = Math.max(26, Math.min(cell, 340 / rows));
  const canvas = h('canvas', { width: width * ratio, height: (above + high * rows + 40) * ratio, role: 'img' });
  canvas.setAttribute('aria-label', `${title}: ${along.length} by ${rows} cells, largest ${withUnit(top, unit)}, mean ${withUnit(mean, unit)}`);
  canvas.style.width = `${width}px`;
  const draw = () => {
    const ctx = canvas.getContext('2d'), table256 = colours('viridis');
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.fillStyle = theme('--panel');
    ctx.fillRect(0, 0, width, canvas.height);
    ctx.font = '12px system-ui, sans-serif';
    ctx.textAlign = 'center';
    ctx.textBaseline = 'middle';
    for (let i = 0; i < along.length; ++i) {
      for (let j = 0; j < rows; ++j) {
        const value = values[i * rows + j], share = value / top;
        const x = left + i * wide, y = above + (rows - 1 - j) * high;
        ctx.fillStyle = css(table256, share);
        ctx.fillRect(x, y, wide - 1, high - 1);
        ctx.fillStyle = isLight(table256, share) ? '#111' : '#fff';
        ctx.fillText(short(value * scale.factor, 3), x + wide / 2, y + high / 2);
      }
    }
    ctx.fillStyle = theme('--muted');
    along.forEach((x, i) => ctx.fillText(short(x * 1e3, 3), left + (i + 0.5) * wide, above + rows * high + 10));
    across.forEach((y, j) => ctx.fillText(short(y * 1e3, 3), left - 22, above + (rows - j - 0.5) * high));
    ctx.fillText('along the track [mm]', left + (width - left) / 2, above + rows * high + 28);
    ctx.save();
    ctx.translate(10, above + (rows * high) / 2);
    ctx.rotate(-Math.PI / 2);
    ctx.fillText('across [mm]', 0, 0);
    ctx.restore();
  };
  draw();
  window.addEventListener('themechange', draw);
  return h('figure', { class: 'chart' },
    h('figcaption', {}, h('span', { class: 'title' }, `${title} [${scale.label}]`),
      h('span', { class: 'tools' },
        button('PNG', () => saveCanvas(canvas, fileName(title, 'png')), { 'aria-label': `Save ${title} as PNG` }),
        button('CSV', () => saveText(csv(table.columns), fileName(title, 'csv')), { 'aria-label': `Save ${title} as CSV` }))),
    h('div', { class: 'scroll', tabindex: '0' }, canvas),
    h('p', { class: 'note' }, `Largest ${withUnit(top, unit)}, mean ${withUnit(mean, unit)}, ratio ${short(top / mean, 3)}; places from the corner of the bottom.`));
}
