// The moment that the 3-D view shows; the charts over time follow it and can set it.

const listeners = new Set();
let now = null;

export const clock = {
  get now() { return now; },
  set(time) {
    now = time;
    for (const listener of listeners) listener(time);
  },
  listen(listener) { listeners.add(listener); },
  forget(listener) { listeners.delete(listener); },
};

/** Set by the 3-D view; a click into a chart over time asks it for that time [s]. */
export const wanted = { ask: () => {} };
