// Elements from values. Texts become text nodes: nothing from a run is ever read as HTML.

/** h('p', { class: 'x', onclick: f }, 'text', element, ...): functions become listeners, true an empty attribute. */
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    if (typeof value === 'function') element.addEventListener(key.slice(2), value);
    else element.setAttribute(key, value === true ? '' : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}

export const button = (label, onclick, attributes = {}) => h('button', { type: 'button', onclick, ...attributes }, label);

/** A labelled control. */
export const field = (label, control) => h('label', { class: 'field' }, h('span', {}, label), control);

export function save(blob, name) {
  const url = URL.createObjectURL(blob);
  h('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60000);
}

export const saveText = (text, name) => save(new Blob([text], { type: 'text/csv;charset=utf-8' }), name);
export const saveCanvas = (canvas, name) => canvas.toBlob((blob) => save(blob, name), 'image/png');

/** A name of a file from any text. */
export const fileName = (text, ending) => `${text.replace(/[^A-Za-z0-9]+/g, '_').replace(/^_+|_+$/g, '') || 'data'}.${ending}`;

/** Value of a custom property of the theme. */
export const theme = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
