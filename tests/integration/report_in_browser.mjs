// report_in_browser.mjs MODULES CHROMIUM PAGE COMPARISON PICTURES: looks at a report as a person would, by mouse and by
// keyboard. Prints what it found; exit code 1 with the first thing that is not as it should be.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

const [modules, executablePath, reportFile, comparisonFile, pictures] = process.argv.slice(2);
const { chromium } = createRequire(path.join(modules, 'x.js'))('playwright-core');
const address = (file) => `file://${encodeURI(file)}`;
const browser = await chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-dev-shm-usage'],
});

const pages = [];

/** A page that notes everything that should not happen. */
async function open(file, colorScheme = 'light') {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, colorScheme, acceptDownloads: true });
  page.setDefaultTimeout(30000);
  page.complaints = [];
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) page.complaints.push(message.text()); });
  page.on('pageerror', (error) => page.complaints.push(String(error)));
  page.on('request', (request) => { if (request.url() !== address(file) && !request.url().startsWith('blob:')) page.complaints.push(`request of ${request.url()}`); });
  pages.push(page);
  await page.goto(address(file));
  await page.waitForSelector('#view');
  return page;
}

/** Number of colours in a PNG, looked at by the browser itself. */
const eye = await browser.newPage();
const coloursIn = (png) => eye.evaluate(async (text) => {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
  const canvas = new OffscreenCanvas(image.width, image.height), ctx = canvas.getContext('2d');
  ctx.drawImage(image, 0, 0);
  return new Set(new Uint32Array(ctx.getImageData(0, 0, image.width, image.height).data.buffer)).size;
}, png.toString('base64'));

async function saved(page, button) {
  const [download] = await Promise.all([page.waitForEvent('download'), button.click()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}
const isPng = (bytes) => bytes.subarray(0, 8).equals(Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]));

/** Texts whose contrast with what is behind them is below 4.5 (WCAG 2, AA). */
const faint = (page) => page.evaluate(() => {
  const canvas = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
  const rgba = (colour) => {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    return [...canvas.getImageData(0, 0, 1, 1).data];
  };
  const light = (c) => [0.2126, 0.7152, 0.0722].reduce((sum, weight, i) => sum + weight * (c[i] / 255 <= 0.03928 ? c[i] / 255 / 12.92 : ((c[i] / 255 + 0.055) / 1.055) ** 2.4), 0);
  const behind = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const colour = rgba(getComputedStyle(at).backgroundColor);
      if (colour[3] === 255) return colour;
    }
    return [255, 255, 255, 255];
  };
  const result = [];
  for (const element of document.querySelectorAll('body *')) {
    const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
    if (!own || !element.checkVisibility() || ['SCRIPT', 'STYLE', 'OPTION'].includes(element.tagName)) continue;
    const a = light(rgba(getComputedStyle(element).color)), b = light(behind(element));
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < 4.5) result.push(`${element.tagName} "${element.textContent.slice(0, 40)}": ${ratio.toFixed(2)}`);
  }
  return result;
});

async function textsStayTexts(page) {
  assert.match(await page.title(), /<img src=x onerror=/, 'the name of the case is the title');
  assert.match(await page.locator('h1').textContent(), /<img src=x onerror=/);
  assert.match(await page.locator('.question').first().textContent(), /<\/script>/);
  assert.equal(await page.locator('img, iframe, object, embed, link').count(), 0, 'no text became an element');
  assert.equal(await page.evaluate(() => window.hacked), undefined, 'no text was run');
}

async function viewMoves(page) {
  const view = page.locator('#view'), slider = page.locator('#time');
  await view.scrollIntoViewIfNeeded();
  const first = await view.screenshot();
  assert.ok((await coloursIn(first)) > 100, 'the canvas is not blank');
  const time = () => page.locator('output.time').textContent();
  await slider.focus();
  await page.keyboard.press('Home');
  const start = await time(), atStart = await view.screenshot();
  await page.keyboard.press('End');
  assert.notEqual(await time(), start, 'the slider changes the time');
  const atEnd = await view.screenshot();
  assert.ok(!atEnd.equals(atStart), 'the slider changes the picture');
  for (const [name, change] of [
    ['colour', () => page.locator('#quantity').selectOption('stress')],
    ['cut plane', () => page.locator('#cut-axis').selectOption('x')],
    ['exaggeration', () => page.locator('#exaggeration').fill('2000')],
    ['colour map', () => page.locator('#map').selectOption('cividis')],
  ]) {
    const before = await view.screenshot();
    await change();
    assert.ok(!(await view.screenshot()).equals(before), `${name} changes the picture`);
  }
  await page.locator('#cut-axis').selectOption('none');
  await page.locator('#exaggeration').fill('1');
}

async function pickShowsAHistory(page) {
  const view = page.locator('#view'), box = await view.boundingBox();
  for (const [x, y] of [[0.5, 0.5], [0.5, 0.6], [0.45, 0.65], [0.55, 0.6], [0.4, 0.55]]) {
    await view.click({ position: { x: x * box.width, y: y * box.height } });
    if ((await page.locator('#history figure').count()) > 0) break;
  }
  assert.equal(await page.locator('#history figure').count(), 3, 'a pick shows displacement, velocity and stress');
  const name = await page.locator('#history .title').first().textContent();
  assert.match(name, /^(stone|sleeper|rail) \d+: displacement$/);
  await page.locator('#history .plot canvas').first().waitFor();
  await page.locator('#history').scrollIntoViewIfNeeded();
  assert.ok((await coloursIn(await page.locator('#history .plot').first().screenshot())) > 20, 'its chart is drawn');
  const chosen = await page.locator('#body').inputValue();
  await view.focus();
  await page.keyboard.press('n');
  assert.notEqual(await page.locator('#body').inputValue(), chosen, 'N goes to the next body');
  const before = await view.screenshot();
  await page.keyboard.press('ArrowLeft');
  assert.ok(!(await view.screenshot()).equals(before), 'arrow keys turn the view');
}

async function buttonsSave(page) {
  const view = await saved(page, page.getByRole('button', { name: 'Save the 3-D view as PNG' }));
  assert.ok(isPng(view.bytes) && (await coloursIn(view.bytes)) > 100, 'the view is saved');
  const seat = page.locator('figure', { hasText: 'Rail seat' }).first();
  await seat.scrollIntoViewIfNeeded();
  const png = await saved(page, seat.getByRole('button', { name: /as PNG/ }));
  assert.ok(png.name.endsWith('.png') && isPng(png.bytes) && (await coloursIn(png.bytes)) > 20, 'a chart is saved as PNG');
  const csv = await saved(page, seat.getByRole('button', { name: /as CSV/ }));
  const lines = csv.bytes.toString().trim().split('\n');
  assert.equal(lines[0], 'time [s],force_on_sleeper [N],rail_displacement [m],sleeper_displacement [m],sleeper_velocity [m/s]');
  assert.ok(lines.length > 100 && lines.slice(1).every((line) => line.split(',').length === 5 && line.split(',').every((cell) => cell !== '' && Number.isFinite(+cell))), 'its data are numbers');
  const titles = await page.locator('figcaption .title').allTextContents();
  for (const wanted of [/Wheel: contact force/, /T\(f,z\)/, /Pressure.*at peak load/, /Displacement of all stones/, /Energies/, /Contacts/]) {
    assert.ok(titles.some((title) => wanted.test(title)), `a chart for ${wanted}`);
  }
}

async function chartSetsTheTime(page) {
  const time = () => page.locator('output.time').textContent();
  const plot = page.locator('figure', { hasText: 'Rail seat' }).first().locator('.u-over'), before = await time();
  await plot.scrollIntoViewIfNeeded();
  const { width, height } = await plot.boundingBox();
  await plot.click({ position: { x: 0.25 * width, y: 0.5 * height } });
  assert.notEqual(await time(), before, 'a click in a chart sets the time of the view');
  assert.ok(await plot.locator('.now').isVisible(), 'and the chart marks it');
}

async function everyChartIsDrawn(page) {
  await page.evaluate(() => { for (const one of document.querySelectorAll('details')) one.open = true; });
  await page.setViewportSize({ width: 1280, height: 30000 });
  await page.waitForFunction(() => [...document.querySelectorAll('.plot')].every((plot) => plot.querySelector('canvas')));
  const n = await page.locator('.plot').count();
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForFunction(() => document.documentElement.scrollWidth <= innerWidth + 1);  // nothing sticks out
  await page.setViewportSize({ width: 1280, height: 900 });
  return n;
}

async function keyboardReachesEverything(page) {
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.className), 'skip', 'the first stop skips to the content');
  const reached = new Set();
  for (let i = 0; i < 30; ++i) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => document.activeElement.id));
  }
  for (const id of ['theme', 'view', 'play', 'time', 'quantity', 'exaggeration', 'cut-axis', 'body']) assert.ok(reached.has(id), `Tab reaches ${id}`);
  const nameless = await page.evaluate(() => [...document.querySelectorAll('button, select, input, canvas[tabindex]')].filter((one) => !(one.getAttribute('aria-label') || one.textContent.trim() || one.labels?.length)).length);
  assert.equal(nameless, 0, 'every control has a name');
}

/** Last, because what the policy refuses is said on the console. */
async function policyHolds(page) {
  const ran = await page.evaluate(async () => {
    const refused = [];
    document.addEventListener('securitypolicyviolation', (event) => refused.push(event.effectiveDirective));
    const script = document.createElement('script');
    script.textContent = 'window.hacked = 1';
    document.body.append(script);
    const fetched = await fetch('http://127.0.0.1:9/').then(() => true, () => false);
    await new Promise((done) => setTimeout(done, 200));
    return { script: window.hacked === 1, fetched, refused };
  });
  assert.deepEqual(ran, { script: false, fetched: false, refused: ['script-src-elem', 'connect-src'] }, 'the policy refuses other scripts and any connection');
}

try {
  const page = await open(reportFile);
  await textsStayTexts(page);
  await page.screenshot({ path: path.join(pictures, 'report.png') });
  await viewMoves(page);
  await pickShowsAHistory(page);
  await buttonsSave(page);
  await chartSetsTheTime(page);
  await page.locator('#view').scrollIntoViewIfNeeded();
  await page.screenshot({ path: path.join(pictures, 'report_view.png') });
  await keyboardReachesEverything(await open(reportFile));
  const n = await everyChartIsDrawn(page);
  assert.deepEqual(await faint(page), [], 'contrast in light');
  await page.locator('#theme').click();
  assert.deepEqual(await faint(page), [], 'contrast in dark');
  await page.screenshot({ path: path.join(pictures, 'report_dark.png'), fullPage: true });
  const several = await open(comparisonFile, 'dark');
  const seat = several.locator('figure', { hasText: 'Rail seat' }).first();
  await seat.scrollIntoViewIfNeeded();
  const legend = await seat.locator('.u-legend').textContent();
  assert.match(legend, /first[\s\S]*second/, 'both runs are in one chart');
  for (const one of pages) assert.deepEqual(one.complaints, [], 'nothing on the console, no request');
  await policyHolds(page);
  console.log(`${n} charts drawn, Chromium ${browser.version()}`);
} catch (error) {
  console.error(error.message ?? error);
  process.exitCode = 1;
}
await browser.close();
