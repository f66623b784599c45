// Lays out the report from the data in the page.
import { redrawCharts } from './charts.js';
import { table } from './decode.js';
import { button, h } from './dom.js';
import { runDetails, runSection } from './facts.js';
import { chartSections } from './tables.js';
import { ViewPanel } from './view_panel.js';

const format = 1;

function themeButton() {
  const root = document.documentElement;
  const isDark = () => (root.dataset.theme ? root.dataset.theme === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches);
  const announce = () => {
    toggle.textContent = isDark() ? '☀ Light' : '☾ Dark';
    redrawCharts();
    window.dispatchEvent(new Event('themechange'));
  };
  const toggle = button('', () => {
    root.dataset.theme = isDark() ? 'light' : 'dark';
    announce();
  }, { id: 'theme' });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', announce);
  announce();
  return toggle;
}

/** Path of the wheel over time from its table, for the 3-D view; nothing without radius or table. */
function wheelOf(run) {
  const path = run.tables.find((one) => /^wheel/.test(one.name));
  const column = (name) => path?.columns.find((candidate) => candidate.name === name)?.values;
  const time = column('time'), x = column('position'), z = column('displacement');
  if (!run.wheel_radius || !time || !x || !z) return null;
  const at = (values) => (wanted) => {
    let i = 0;
    while (i < time.length - 1 && time[i] < wanted) ++i;
    return values[i];
  };
  return { radius: run.wheel_radius, x: at(x), dz: at(z) };
}

function viewSection(data) {
  const { scene } = data, several = data.runs.length > 1;
  const heading = h('h2', { id: 'view-heading' }, several ? `Bodies in motion: ${data.runs[0].name}` : 'Bodies in motion');
  if (scene.note) return h('section', {}, heading, h('p', { class: 'note' }, scene.note));
  try {
    const peak = data.runs[0].figures.find((figure) => figure.group.startsWith('load, ') && figure.name === 'at');
    const panel = new ViewPanel(scene, wheelOf(data.runs[0]), peak?.value ?? undefined);
    const share = scene.frames.length === scene.outputs ? `all ${scene.outputs} outputs of the run` : `${scene.frames.length} of the ${scene.outputs} outputs of the run, thinned to keep the page below its size`;
    return h('section', { 'aria-labelledby': 'view-heading' }, heading, panel.element, panel.history,
      h('p', { class: 'note' }, `Surfaces of the bodies in ${share}. Values are stored in steps of 1/32767 of the largest of each frame; displacements count from time 0; the stress of a point is the mean of the cells around it; the colours follow stones and sleeper.`));
  } catch (error) {
    console.info('no 3-D view', error);
    return h('section', {}, heading, h('p', { class: 'note' }, `The 3-D view needs WebGL, which this browser does not give (${error.message}). Everything else is below.`));
  }
}

function chartSection({ heading, folded, figures }) {
  const content = h('div', { class: 'charts' });
  if (!folded) {
    content.append(...figures());
    return h('section', {}, h('h2', {}, heading), content);
  }
  const fill = (event) => { if (event.target.open && !content.hasChildNodes()) content.append(...figures()); };
  return h('section', {}, h('details', { class: 'group', ontoggle: fill }, h('summary', {}, h('h2', {}, heading)), content));
}

function layOut(data) {
  const names = data.runs.map((run) => run.name).join(' · ');
  document.title = `${names}: report`;
  const runs = data.runs.map((run) => ({ ...run, tables: run.tables.map((raw) => table(raw, run.name === run.folder ? run.name : `${run.name} (${run.folder})`)) }));
  data = { ...data, runs };
  document.getElementById('top').append(
    h('div', {}, h('p', { class: 'kicker' }, runs.length > 1 ? 'Comparison of runs' : 'Report of a run'), h('h1', {}, names)), themeButton());
  const main = document.getElementById('main');
  main.replaceChildren(...runs.map((run) => runSection(run, runs.length > 1)));
  main.append(viewSection(data));
  main.append(...chartSections(runs).map(chartSection));
  main.append(h('section', {}, h('h2', {}, 'Behind the pictures'), runs.map((run) => runDetails(run, runs.length > 1))));
  document.getElementById('bottom').append(h('p', {}, `Made by ${data.program}. This page holds all of its data and loads nothing.`));
}

const data = JSON.parse(document.getElementById('run-data').textContent);
if (data.format !== format) {
  document.getElementById('main').replaceChildren(h('p', {}, `This page reads data of format ${format} and was given format ${data.format}: build report_page and coupler together.`));
} else {
  layOut(data);
}
