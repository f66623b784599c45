// One chart with its legend and its two buttons. Charts of the same kind of abscissa share the cursor.
import uPlot from 'uplot';
import { clock, wanted } from './clock.js';
import { button, fileName, h, saveCanvas, saveText, theme } from './dom.js';
import { largest, scaled, short, words } from './units.js';

const height = 250;
const dashes = [undefined, [8, 4], [2, 3], [10, 3, 2, 3]];
const drawn = new Set();

export const seriesColour = (i) => theme(`--series-${(i % 8) + 1}`);

/** Redraws every chart, after the theme has changed. */
export function redrawCharts() {
  for (const chart of drawn) chart.redraw(false);
}

/** Ends the charts inside `place`. */
export function forgetCharts(place) {
  for (const chart of [...drawn]) {
    if (!place.contains(chart.root)) continue;
    drawn.delete(chart);
    chart.destroy();
  }
}

/** The moment of the 3-D view as a line over a chart whose abscissa is time, `factor` times seconds. */
function timeMarker(factor) {
  const line = h('div', { class: 'now' });
  let follow;
  return {
    hooks: {
      ready: [(u) => {
        u.over.append(line);
        follow = (time) => {
          const left = time === null ? -1 : u.valToPos(time * factor, 'x');
          line.style.display = left >= 0 && left <= u.over.clientWidth ? 'block' : 'none';
          line.style.left = `${left}px`;
        };
        clock.listen(follow);
        follow(clock.now);
        let pressed = 0;
        u.over.addEventListener('mousedown', (event) => { pressed = event.clientX; });
        u.over.addEventListener('click', (event) => {
          if (Math.abs(event.clientX - pressed) < 4) wanted.ask(u.posToVal(u.cursor.left, 'x') / factor);
        });
      }],
      setScale: [() => follow?.(clock.now)],
      setSize: [() => follow?.(clock.now)],
      destroy: [() => clock.forget(follow)],
    },
  };
}

/** Title, picture and legend of a chart on one canvas. */
function picture(u, title) {
  const ratio = devicePixelRatio;
  const canvas = h('canvas', { width: u.ctx.canvas.width, height: u.ctx.canvas.height + (44 + 18 * u.series.length) * ratio });
  const ctx = canvas.getContext('2d');
  ctx.fillStyle = theme('--panel');
  ctx.fillRect(0, 0, canvas.width, canvas.height);
  ctx.drawImage(u.ctx.canvas, 0, 34 * ratio);
  ctx.scale(ratio, ratio);
  ctx.fillStyle = theme('--text');
  ctx.font = '600 15px system-ui, sans-serif';
  ctx.fillText(title, 12, 22);
  ctx.font = '13px system-ui, sans-serif';
  let y = 34 + u.ctx.canvas.height / ratio + 14;
  for (const series of u.series.slice(1).filter((one) => one.show && !one.helper)) {
    ctx.fillStyle = series.colour;
    ctx.fillRect(14, y - 5, 18, 3);
    ctx.fillStyle = theme('--text');
    ctx.fillText(series.label, 40, y);
    y += 18;
  }
  return canvas;
}

const isDecade = (value) => Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9;

function axis(label, side, logarithmic) {
  const colour = () => theme('--muted');
  const grid = { stroke: () => theme('--grid'), width: 1 };
  if (logarithmic) grid.filter = (u, splits) => splits.map((value) => (isDecade(value) ? value : null));
  return { label, labelSize: 22, labelFont: '12px system-ui', font: '12px system-ui', size: side === 'y' ? 64 : 36, stroke: colour, grid, ticks: grid,
    values: (u, splits) => splits.map((value) => (value === null ? '' : short(value))) };
}

/** Rows without a repeated or unordered abscissa; what is not positive is left out of a logarithmic scale. */
function aligned(chart, xFactor, yFactor) {
  const tables = chart.lines.map((line) => {
    const order = Array.from(line.x.keys());
    if (chart.points) order.sort((a, b) => line.x[a] - line.x[b]);
    const y = order.map((i) => {
      const value = line.y[i] * yFactor;
      return Number.isFinite(value) && (!chart.logarithmic || value > 0) ? value : null;
    });
    return [order.map((i) => line.x[i] * xFactor), y];
  });
  const same = tables.every((table) => table[0].length === tables[0][0].length && table[0].every((x, i) => x === tables[0][0][i]));
  return same ? [tables[0][0], ...tables.map((table) => table[1])] : uPlot.join(tables);
}

/** Range of the ordinate: at most nine decades, and never so narrow that numbers cannot tell its ticks apart. */
function range(logarithmic) {
  return (u, low, high) => {
    if (low === null || high === null) return logarithmic ? [1, 10] : [0, 1];
    if (logarithmic) return uPlot.rangeLog(Math.max(low, 1e-9 * high), high, 10, true);
    const size = Math.max(Math.abs(low), Math.abs(high));
    return high - low > 1e-7 * size ? uPlot.rangeNum(low, high, 0.1, true) : [low - (0.05 * size || 1), high + (0.05 * size || 1)];
  };
}

function options(chart, width, x, y) {
  const series = chart.lines.map((line, i) => {
    const stroke = () => (line.helper ? 'transparent' : seriesColour(line.colour ?? i));
    return {
      label: line.label,
      helper: line.helper,
      get colour() { return seriesColour(line.colour ?? i); },
      stroke,
      width: line.helper ? 0 : 1.75,
      dash: dashes[(line.run ?? 0) % dashes.length],
      spanGaps: true,
      paths: chart.points ? () => null : undefined,
      points: { show: !line.helper && (chart.points || line.x.length < 40), size: 5, fill: stroke },
      value: (u, value) => (value === null || value === undefined ? '–' : `${short(value)} ${y.label}`),
    };
  });
  const isTime = chart.x.name === 'time';
  return {
    width,
    height,
    scales: { x: { time: false }, y: { distr: chart.logarithmic ? 3 : 1, range: range(chart.logarithmic) } },
    series: [{ label: words(chart.x.name), value: (u, value) => (value === null ? '–' : `${short(value)} ${x.label}`) }, ...series],
    bands: (chart.bands ?? []).map((pair) => ({ series: [pair.high + 1, pair.low + 1], fill: () => `${seriesColour(pair.colour)}2a` })),
    axes: [axis(`${words(chart.x.name)}${x.label ? ` [${x.label}]` : ''}`, 'x'), axis(y.label ? `[${y.label}]` : (chart.quantity ?? '').length < 30 ? chart.quantity ?? '' : '', 'y', chart.logarithmic)],
    cursor: { sync: { key: chart.x.name }, drag: { x: true, y: false } },
    legend: { live: true },
    plugins: isTime ? [timeMarker(x.factor)] : [],
  };
}

/**
 * chart: { title, x: { name, unit }, unit, lines: [{ label, x, y, colour?, run?, helper? }], csv: () => text,
 * logarithmic?, points?, bands?, quantity?, note? }. Drawn when it comes into view. Returns its figure element.
 */
export function chartFigure(chart) {
  const place = h('div', { class: 'plot' });
  place.style.minHeight = `${height}px`;
  let u = null;
  const draw = () => {
    if (u) return u;
    const x = scaled(chart.x.unit, Math.max(...chart.lines.map((line) => largest(line.x))));
    const y = scaled(chart.unit, Math.max(...chart.lines.filter((line) => !line.helper).map((line) => largest(line.y))));
    u = new uPlot(options(chart, Math.max(280, place.clientWidth), x, y), aligned(chart, x.factor, y.factor), place);
    u.root.querySelectorAll('.u-legend .u-series').forEach((row, i) => { if (chart.lines[i - 1]?.helper) row.hidden = true; });
    drawn.add(u);
    new ResizeObserver(() => { if (place.clientWidth > 0) u.setSize({ width: place.clientWidth, height }); }).observe(place);
    return u;
  };
  new IntersectionObserver((entries, observer) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    draw();
  }, { rootMargin: '300px' }).observe(place);
  const name = (ending) => fileName(chart.title, ending);
  return h('figure', { class: 'chart' },
    h('figcaption', {},
      h('span', { class: 'title' }, chart.title),
      h('span', { class: 'tools' },
        button('PNG', () => saveCanvas(picture(draw(), chart.title), name('png')), { 'aria-label': `Save the chart ${chart.title} as PNG` }),
        button('CSV', () => saveText(chart.csv(), name('csv')), { 'aria-label': `Save the data of ${chart.title} as CSV` }))),
    place,
    chart.note ? h('p', { class: 'note' }, chart.note) : null);
}
