// Viridis and cividis: even in lightness, readable with any colour vision and in grey.

const anchors = {
  viridis: ['440154', '482878', '3e4989', '31688e', '26828e', '1f9e89', '35b779', '6ece58', 'b5de2b', 'fde725'],
  cividis: ['00224e', '123570', '3b496c', '575d6d', '707173', '8a8678', 'a59c74', 'c3b369', 'e1cc55', 'fee838'],
};
export const mapNames = Object.keys(anchors);

const channels = (hex) => [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);

/** 256 colours [r, g, b] in 0..1 (sRGB), one after the other. */
export function colours(name) {
  const stops = anchors[name].map(channels);
  const table = new Float32Array(3 * 256);
  for (let i = 0; i < 256; ++i) {
    const place = (i / 255) * (stops.length - 1);
    const k = Math.min(Math.floor(place), stops.length - 2);
    for (let c = 0; c < 3; ++c) table[3 * i + c] = stops[k][c] + (place - k) * (stops[k + 1][c] - stops[k][c]);
  }
  return table;
}

export function css(table, share) {
  const i = 3 * Math.round(255 * Math.min(1, Math.max(0, share)));
  return `rgb(${[0, 1, 2].map((c) => Math.round(255 * table[i + c])).join(',')})`;
}

/** Whether dark text reads better than light text on that colour. */
export function isLight(table, share) {
  const i = 3 * Math.round(255 * Math.min(1, Math.max(0, share)));
  return 0.2126 * table[i] ** 2.2 + 0.7152 * table[i + 1] ** 2.2 + 0.0722 * table[i + 2] ** 2.2 > 0.18;
}
