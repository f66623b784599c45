// The 3-D view with its controls: time, colour, exaggeration, cut, picking.
import { forgetCharts } from './charts.js';
import { clock, wanted } from './clock.js';
import { colours, css, mapNames } from './colour_map.js';
import { button, field, h, saveCanvas } from './dom.js';
import { bodyHistory } from './history.js';
import { Scene } from './scene.js';
import { largest, scaled, short, withUnit } from './units.js';

const quantities = { displacement: ['Displacement', 'm'], speed: ['Velocity', 'm/s'], stress: ['Von Mises stress', 'Pa'] };
const steps = [1, 2, 5];

/** 1, 2 or 5 times a power of ten, at most `value`. */
function rounded(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * steps.filter((step) => step * power <= value * 1.0001).pop();
}

/** What only one in fifty values of all frames exceeds. */
function usualTop(part, quantity, n_frames) {
  const sample = [];
  for (let frame = 0; frame < n_frames; ++frame) {
    const values = part.magnitudes(quantity, frame);
    for (let i = frame % 7; i < values.length; i += 7) if (Number.isFinite(values[i])) sample.push(values[i]);
  }
  sample.sort((a, b) => a - b);
  return sample[Math.floor(0.98 * (sample.length - 1))] || largest(sample) || 1;
}

const select = (choices, value, onchange, attributes = {}) => h('select', { onchange: (event) => onchange(event.target.value), ...attributes },
  Object.entries(choices).map(([key, label]) => h('option', { value: key, selected: key === value }, label)));

export class ViewPanel {
  /** `time`: what to show first [s]; without it the frame of the largest displacement. */
  constructor(raw, wheel, time) {
    this.raw = raw;
    this.n = raw.frames.length;
    this.ranges = {};
    this.canvas = h('canvas', { tabindex: '0', id: 'view', role: 'application', 'aria-describedby': 'view-help',
      'aria-label': '3-D view of the bodies. Arrow keys turn, plus and minus zoom, N and P go through the bodies, space plays, Home resets.' });
    this.stage = h('div', { class: 'stage' }, this.canvas);
    this.scene = new Scene(raw, this.canvas, wheel);
    const kinds = new Set(raw.parts.flatMap((part) => part.bodies.map((body) => body.kind)));
    const sizes = raw.parts[0].frames.map((frame) => frame.displacement.step);
    const frame = time === undefined ? sizes.indexOf(Math.max(...sizes)) : this.frameAt(time);
    const size = this.scene.box.max.distanceTo(this.scene.box.min), moved = usualTop(this.scene.parts[0], 'displacement', this.n);
    this.state = { frame, quantity: 'displacement', range: 1, exaggeration: moved > 0 ? Math.max(1, rounded((0.02 * size) / moved)) : 1, map: 'viridis', hidden: new Set(), cut: { axis: 'none', share: 0.5 } };
    this.element = h('div', { class: 'view' }, h('div', { class: 'view-left' }, this.stage, this.timeBar(), this.legend()), this.controls(kinds));
    this.history = h('div', { class: 'charts', id: 'history', 'aria-live': 'polite' });
    this.listenToCanvas();
    wanted.ask = (time) => this.setFrame(this.frameAt(time));
    window.addEventListener('themechange', () => this.update());
    this.update();
  }

  frameAt(time) {
    return this.raw.frames.reduce((best, t, i, all) => (Math.abs(t - time) < Math.abs(all[best] - time) ? i : best), 0);
  }

  timeBar() {
    this.slider = h('input', { type: 'range', id: 'time', min: '0', max: String(this.n - 1), step: '1', 'aria-label': 'Time', oninput: () => this.setFrame(+this.slider.value) });
    this.timeText = h('output', { for: 'time', class: 'time' });
    this.player = button('▶ Play', () => this.play(), { id: 'play' });
    return h('div', { class: 'time-bar' }, this.player, this.slider, this.timeText);
  }

  legend() {
    this.scaleBar = h('canvas', { width: '256', height: '1', class: 'scale', role: 'img' });
    this.scaleText = h('span', { class: 'scale-text' });
    return h('div', { class: 'legend' }, this.scaleBar, this.scaleText);
  }

  controls(kinds) {
    const set = (key) => (value) => { this.state[key] = value; this.update(); };
    const exaggeration = h('input', { type: 'number', id: 'exaggeration', min: '0', max: '1000000', step: 'any', value: String(this.state.exaggeration),
      oninput: (event) => { if (event.target.value !== '' && +event.target.value >= 0) set('exaggeration')(+event.target.value); } });
    const place = h('input', { type: 'range', id: 'cut', min: '0', max: '1', step: '0.01', value: '0.5', disabled: true,
      oninput: (event) => { this.state.cut.share = +event.target.value; this.update(); } });
    const cut = select({ none: 'none', x: 'across the track (x)', y: 'along the track (y)', z: 'horizontal (z)' }, 'none', (axis) => {
      this.state.cut.axis = axis;
      place.disabled = axis === 'none';
      this.update();
    }, { id: 'cut-axis' });
    this.number = select({ '': 'none', ...Object.fromEntries(this.bodies().map(([p, b, name]) => [`${p}/${b}`, name])) }, '', (value) => this.choose(value), { id: 'body' });
    const shown = ['stone', 'sleeper', 'rail'].filter((kind) => kinds.has(kind)).map((kind) => h('label', { class: 'check' },
      h('input', { type: 'checkbox', checked: true, onchange: (event) => { this.state.hidden[event.target.checked ? 'delete' : 'add'](kind); this.update(); } }),
      kind === 'rail' && this.scene.wheel ? 'rail and wheel' : `${kind}s`));
    return h('form', { class: 'controls', onsubmit: (event) => event.preventDefault() },
      field('Colour', select(Object.fromEntries(Object.entries(quantities).map(([key, [label]]) => [key, label])), 'displacement', set('quantity'), { id: 'quantity' })),
      field('Colour map', select(Object.fromEntries(mapNames.map((name) => [name, name])), 'viridis', set('map'), { id: 'map' })),
      field('Exaggeration of displacements', exaggeration),
      field('Cut plane', cut), field('Place of the cut', place),
      h('fieldset', {}, h('legend', {}, 'Show'), shown),
      field('History of body', this.number),
      h('div', { class: 'row' }, button('Reset view', () => this.scene.home()), button('PNG', () => this.savePicture(), { 'aria-label': 'Save the 3-D view as PNG' })),
      h('p', { class: 'note', id: 'view-help' }, 'Drag to turn, right button to shift, wheel to zoom once the view has the focus. Click a body for its history. Keys: arrows, + and −, N and P for the next body, space plays.'));
  }

  bodies() {
    return this.raw.parts.flatMap((part, p) => part.bodies.map((body, b) => [p, b, part.bodies.length === 1 ? body.kind : `${body.kind} ${body.number}`]));
  }

  setFrame(frame) {
    this.state.frame = Math.min(this.n - 1, Math.max(0, frame));
    this.update();
  }

  update() {
    const { quantity, frame, map } = this.state, [label, unit] = quantities[quantity], time = this.raw.frames[frame];
    const top = (this.ranges[quantity] ??= usualTop(this.scene.parts[0], quantity, this.n));
    this.state.range = top;
    this.scene.show(this.state);
    this.slider.value = String(frame);
    const { factor, label: timeUnit } = scaled('s', largest(this.raw.frames));
    this.timeText.value = `${short(time * factor)} ${timeUnit}`;
    this.slider.setAttribute('aria-valuetext', this.timeText.value);
    const table = colours(map), ctx = this.scaleBar.getContext('2d');
    for (let i = 0; i < 256; ++i) {
      ctx.fillStyle = css(table, i / 255);
      ctx.fillRect(i, 0, 1, 1);
    }
    const now = largest(this.scene.parts[0].magnitudes(quantity, frame));
    this.scaleText.textContent = `${label}: 0 to ${withUnit(top, unit, 3)} and above; largest now ${withUnit(now, unit, 3)}. Displacements × ${short(this.state.exaggeration)}.`;
    this.scaleBar.setAttribute('aria-label', this.scaleText.textContent);
    clock.set(time);
  }

  play() {
    clearTimeout(this.timer);
    this.playing = !this.playing;
    this.player.textContent = this.playing ? '❚❚ Stop' : '▶ Play';
    if (this.playing && this.state.frame === this.n - 1) this.setFrame(0);
    const tick = () => {
      if (!this.playing) return;
      if (this.state.frame < this.n - 1) {
        this.setFrame(this.state.frame + 1);
        this.timer = setTimeout(tick, 60);
      } else {
        this.play();
      }
    };
    tick();
  }

  /** `value` as in the list of bodies, or ''. */
  choose(value) {
    forgetCharts(this.history);
    this.number.value = value;
    if (value === '') {
      this.scene.select(null);
      this.history.replaceChildren();
      return;
    }
    const [p, b] = value.split('/').map(Number), part = this.scene.parts[p];
    this.scene.select({ part, body: b });
    this.history.replaceChildren(...bodyHistory(part, b, this.raw.history_time));
  }

  pick(x, y) {
    const hit = this.scene.pick(x, y);
    this.choose(hit ? `${this.scene.parts.indexOf(hit.part)}/${hit.body}` : '');
  }

  listenToCanvas() {
    let pressed = null;
    this.canvas.addEventListener('pointerdown', (event) => {
      pressed = [event.clientX, event.clientY];
      this.canvas.focus({ preventScroll: true });
    });
    this.canvas.addEventListener('pointerup', (event) => {
      if (event.button !== 0 || !pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
      const box = this.canvas.getBoundingClientRect();
      this.pick((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    });
    const next = (step) => {
      const all = this.bodies().map(([p, b]) => `${p}/${b}`), at = all.indexOf(this.number.value);
      this.choose(all[(at + step + all.length) % all.length]);
    };
    const keys = {
      ArrowLeft: () => this.scene.orbit(-0.1, 0, 1), ArrowRight: () => this.scene.orbit(0.1, 0, 1),
      ArrowUp: () => this.scene.orbit(0, -0.1, 1), ArrowDown: () => this.scene.orbit(0, 0.1, 1),
      '+': () => this.scene.orbit(0, 0, 0.9), '-': () => this.scene.orbit(0, 0, 1.1), Home: () => this.scene.home(),
      n: () => next(1), p: () => next(-1), ' ': () => this.play(), Enter: () => this.pick(0.5, 0.5),
    };
    this.canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
  }

  savePicture() {
    this.scene.render();
    saveCanvas(this.canvas, `view_${this.state.quantity}_${this.state.frame}.png`);
  }
}
