// Numbers out of base64, as coupler/page/encode.cpp writes them.

function buffer(text) {
  const plain = atob(text);
  const bytes = new Uint8Array(plain.length);
  for (let i = 0; i < plain.length; ++i) bytes[i] = plain.charCodeAt(i);
  return bytes.buffer;
}

export const floats = (text) => new Float32Array(buffer(text));
export const indices = (text) => new Uint32Array(buffer(text));

/** { step, i16 }: value = step * integer; -32768 stands for no number. */
export function quantised({ step, i16 }) {
  const integers = new Int16Array(buffer(i16));
  const values = new Float32Array(integers.length);
  for (let i = 0; i < values.length; ++i) values[i] = integers[i] === -32768 ? NaN : step * integers[i];
  return values;
}

/** A table with its numbers decoded when they are first asked for. */
export function table(raw, run) {
  return {
    name: raw.name,
    rows: raw.rows,
    block: raw.block,
    run,
    columns: raw.columns.map((column) => {
      let values;
      return { name: column.name, unit: column.unit, get values() { return (values ??= floats(column.f32)); } };
    }),
  };
}

export function csv(columns) {
  const quote = (text) => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
  const lines = [columns.map((column) => quote(`${column.name} [${column.unit}]`)).join(',')];
  for (let row = 0; row < columns[0].values.length; ++row) {
    lines.push(columns.map((column) => {
      const value = column.values[row];
      return Number.isFinite(value) ? String(+value.toPrecision(7)) : '';
    }).join(','));
  }
  return `${lines.join('\n')}\n`;
}
