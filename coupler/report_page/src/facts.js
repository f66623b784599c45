// The run in words and numbers.
import { h } from './dom.js';
import { short, withUnit, words } from './units.js';

const at = (data, path) => path.split('.').reduce((value, key) => value?.[key], data);

function card(label, value, note, state) {
  return h('div', { class: `card ${state ?? ''}` }, h('dt', {}, label), h('dd', { class: 'value' }, value), note ? h('dd', {}, note) : null);
}

/** A defect of the interface, relative, with what the case asks of it. */
function limited(label, run, name) {
  const value = at(run.summary, `interface.${name}_defect_relative`), limit = run.audit_limits?.[name];
  if (typeof value !== 'number' || limit === undefined) return null;
  const good = value <= limit;
  return card(label, short(value, 3), `${good ? '✓ within' : '✗ above'} the ${short(limit)} asked for`, good ? 'good' : 'bad');
}

function cards(run) {
  const { summary } = run;
  const seats = summary.rail_seats ?? [];
  const seat = seats.reduce((best, one) => (one.max_force_n > (best?.max_force_n ?? -1) ? one : best), null);
  const wheel = at(summary, 'fem.largest_contact_force_n'), total = at(summary, 'wall_s.total');
  return h('dl', { class: 'cards' },
    run.status ? card('Status', run.status, `${summary.windows ?? '–'} of ${summary.windows_wanted ?? '–'} windows`, run.status === 'ok' ? 'good' : 'bad') : null,
    seat ? card('Largest seat force', withUnit(seat.max_force_n, 'N', 3), `at ${seat.name}`) : null,
    seat ? card('Largest displacement', withUnit(seat.max_rail_displacement_m, 'm', 3), `rail; sleeper ${withUnit(seat.max_sleeper_displacement_m, 'm', 3)}`) : null,
    wheel ? card('Wheel on rail, largest', withUnit(wheel, 'N', 3), 'contact force') : null,
    limited('Energy created at the interface', run, 'energy'),
    limited('Momentum lost at the interface', run, 'momentum'),
    limited('Moment lost at the interface', run, 'moment'),
    total ? card('Wall time', `${short(total, 3)} s`, summary.scheme ? `scheme ${summary.scheme}` : '') : null);
}

/** Where the wall time went, as one bar. */
function timing(wall) {
  const parts = ['start_up', 'qdem', 'fem', 'coupler', 'waiting'].filter((name) => wall?.[name] > 0);
  if (parts.length === 0) return null;
  const sum = parts.reduce((all, name) => all + wall[name], 0);
  const bar = h('div', { class: 'bar', 'aria-hidden': 'true' });
  const legend = h('ul', { class: 'bar-legend' });
  parts.forEach((name, i) => {
    const piece = h('span', { class: `fill-${i + 1}` });
    piece.style.width = `${(100 * wall[name]) / sum}%`;
    bar.append(piece);
    legend.append(h('li', {}, h('span', { class: `dot fill-${i + 1}` }), `${words(name)} ${short(wall[name], 3)} s (${short((100 * wall[name]) / sum, 2)} %)`));
  });
  return h('section', {}, h('h3', {}, 'Timing'), bar, legend);
}

/** Nested values of summary.json, one row each. */
function rows(data, path = '') {
  return Object.entries(data ?? {}).flatMap(([key, value]) => {
    const name = path ? `${path}.${key}` : key;
    if (value !== null && typeof value === 'object') return rows(value, name);
    return [[name, typeof value === 'number' ? short(value, 6) : String(value)]];
  });
}

function listing(pairs) {
  return h('div', { class: 'scroll', tabindex: '0' }, h('table', { class: 'facts' }, h('tbody', {}, pairs.map(([key, value]) => h('tr', {}, h('th', { scope: 'row' }, key), h('td', {}, value))))));
}

const fold = (label, content, open = false) => h('details', { open }, h('summary', {}, label), content);

function findings(run) {
  const groups = new Map();
  for (const figure of run.figures) {
    const value = figure.value === null ? '–' : withUnit(figure.value, figure.unit);
    groups.set(figure.group, [...(groups.get(figure.group) ?? []), [figure.name, value]]);
  }
  if (groups.size === 0) return null;
  return fold('All figures of the analysis', h('div', { class: 'columns' }, [...groups].map(([group, pairs]) => h('div', {}, h('h4', {}, group), listing(pairs)))));
}

const list = (heading, texts) => (texts.length === 0 ? null : h('section', {}, h('h3', {}, heading), h('ul', {}, texts.map((text) => h('li', {}, text)))));

export function runSection(run, several) {
  return h('section', { class: 'run' },
    h('h2', {}, several ? `${run.name} (${run.folder})` : 'The case'),
    run.question ? h('p', { class: 'question' }, run.question) : null,
    run.words.length ? h('p', {}, run.words.join(' ')) : null,
    cards(run));
}

/** What stands behind the pictures; at the end of the page. */
export function runDetails(run, several) {
  return h('section', {},
    several ? h('h3', {}, run.name) : null,
    timing(run.summary.wall_s),
    list('Warnings', run.warnings),
    list('What the analysis lacks', run.notes),
    findings(run),
    Object.keys(run.summary).length ? fold('Summary of the run (summary.json)', listing(rows(run.summary))) : null,
    run.provenance.length ? fold('Provenance', listing(run.provenance)) : null,
    run.case_text ? fold('The case as it was run (case.toml)', h('pre', { tabindex: '0' }, run.case_text)) : null);
}
