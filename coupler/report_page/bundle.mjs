// bundle.mjs SRC NODE_MODULES PAGE: one HTML file with script and style in it, whose content security policy names both
// by their hashes. Data goes in later, in place of __RUN_DATA__.
import { createHash } from 'node:crypto';
import { readFileSync, renameSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

const [src, modules, page] = process.argv.slice(2);
const esbuild = createRequire(path.join(modules, 'x.js'))('esbuild');

async function bundle(entry, options) {
  const result = await esbuild.build({
    entryPoints: [path.join(src, entry)],
    nodePaths: [modules],
    bundle: true,
    minify: true,
    write: false,
    legalComments: 'eof',
    ...options,
  });
  return result.outputFiles[0].text.trim();
}

const script = await bundle('main.js', { format: 'iife', target: 'es2020' });
const style = await bundle('style.css', {});
for (const [text, end] of [[script, '</script'], [style, '</style']]) {
  if (text.toLowerCase().includes(end)) throw new Error(`the bundle holds ${end}`);
}
const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
const policy = `default-src 'none'; script-src ${hash(script)}; style-src ${hash(style)}; base-uri 'none'; form-action 'none'`;
let html = readFileSync(path.join(src, 'page.html'), 'utf8');
for (const [name, text] of [['__POLICY__', policy], ['__STYLE__', style], ['__SCRIPT__', script]]) {
  html = html.split(name).join(text);
}
if (html.split('__RUN_DATA__').length !== 2) throw new Error('the page must have one place for the data');
writeFileSync(`${page}.new`, html);
renameSync(`${page}.new`, page);
console.log(`${page}: ${(html.length / 1024).toFixed(0)} KiB`);
