// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node painters_test.mjs PROGRAM PACKAGES SCRATCH: the flock as the processor draws it is the flock
// as the browser's WebGL draws it.

import assert from 'node:assert/strict';
import { rmSync } from 'node:fs';
import { join } from 'node:path';

import { openBrowser, openPage, run, serve, until } from './harness.mjs';
import { makeRun } from './make_run.mjs';

const [program, packages, scratch] = process.argv.slice(2);
const browser = await openBrowser(packages);
rmSync(scratch, { recursive: true, force: true });
makeRun(scratch);
run(program, ['reconstruct', join(scratch, 'tracks.csv'), '--camera', join(scratch, 'camera.yaml'),
  '--wingspan', '0.7,0.05', '--speed', '4.5,1', '--out', scratch, '--quiet']);
const server = await serve(program, [scratch]);
const pages = [];
for (const how of ['', '#card']) pages.push(await openPage(browser, server.address + how));

// The picture in blocks of 4 x 4 pixels: edges are smooth in one of the two, and lines may be a
// pixel apart.
const blocks = ({ page }, choices) => page.evaluate(async (state) => {
  const { run, flight } = window.flocklift;
  run.store.set(state);
  run.clock.go(30);
  flight.draw();
  const space = flight.space.picture;
  const [w, h] = [Math.floor(space.clientWidth / 4), Math.floor(space.clientHeight / 4)];
  const small = new OffscreenCanvas(w, h).getContext('2d');
  small.imageSmoothingQuality = 'high';
  small.drawImage(space, 0, 0, w, h);
  return [...small.getImageData(0, 0, w, h).data];
}, choices);

for (const opened of pages) {
  await until('the flock', () => opened.page.evaluate(() => {
    window.flocklift?.run.clock.go(30);
    return document.querySelector('.flight canvas')?.dataset.frame === '30';
  }));
}
// The processor draws first, in both; the card takes over.
await until('the card', () => pages[1].page.evaluate(() =>
  window.flocklift.flight.space.picture.getContext('webgl2') !== null));
await until('the parts that come later', () => pages[0].page.locator('.panel-body').isVisible());
if (!(await pages[0].page.evaluate(() => window.flocklift.flight.space.isDrawnByProcessor))) {
  console.log('skipped: the browser has a graphics card, so both are drawn alike');
  process.exit(77);
}

const away = { bars: false, trails: 0, grid: false, ghost: 'none' };
const scenes = [
  { ...away, view: 'orbit', birdScale: 4 },
  { ...away, view: 'top', grid: true, birdScale: 4 },
  { ...away, view: 'camera', trails: 30, birdScale: 4, dark: true },
  { ...away, view: 'side', bars: true, selected: 1, birdScale: 4 },
  { ...away, view: 'orbit', ghost: 'before', dark: false, birdScale: 4 },
];
async function compare(choices) {
  const [soft, card] = await Promise.all(pages.map((opened) => blocks(opened, choices)));
  assert.equal(soft.length, card.length);
  let coloured = 0;
  let apart = 0;
  for (let k = 0; k < soft.length; k += 4) {
    const spread = (p) => Math.max(p[k], p[k + 1], p[k + 2]) - Math.min(p[k], p[k + 1], p[k + 2]);
    if (spread(card) > 40) coloured++;
    if ([0, 1, 2].some((c) => Math.abs(soft[k + c] - card[k + c]) > 60)) apart++;
  }
  const words = `${JSON.stringify(choices)}: ${apart} of ${coloured} coloured blocks differ`;
  assert.ok(coloured > 20, words);
  assert.ok(apart < 0.1 * coloured, words);
  console.log('ok: ' + words);
}
for (const choices of scenes) await compare(choices);

// What the card draws is clicked through.
{
  const { page } = pages[1];
  const choose = (animal) => page.evaluate((a) => window.flocklift.run.store.set({ selected: a }), animal);
  const chosen = () => page.evaluate(() => window.flocklift.run.store.get().selected);
  const inFilm = await page.evaluate(() => window.flocklift.footage.onScreen(2));
  const box = await page.locator('.flight canvas').first().boundingBox();
  const inSpace = await page.evaluate(() => {
    const { run, flight } = window.flocklift;
    const rows = run.before.at(30);
    const r = rows.start[30 - rows.first] + 3;
    return [rows.animal[r], ...flight.space.onCanvas(...rows.position.subarray(3 * r, 3 * r + 3))];
  });
  for (const [animal, x, y] of [[2, ...inFilm], [inSpace[0], box.x + inSpace[1], box.y + inSpace[2]]]) {
    await choose(-1);
    await page.mouse.click(x, y);
    assert.equal(await chosen(), animal);
  }
  await choose(1); // as on the other page
  assert.equal(await page.locator('canvas.over').count(), 2);
  console.log('ok: clicks go through what the card draws');
}

// Without being asked to, it draws again.
await pages[1].page.evaluate(async () => {
  const { run, flight } = window.flocklift;
  const canvas = flight.space.picture;
  const card = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
  const event = (name) => new Promise((resolve) => canvas.addEventListener(name, resolve, { once: true }));
  const [lost, restored] = [event('webglcontextlost'), event('webglcontextrestored')];
  card.loseContext();
  await lost;
  await new Promise((resolve) => setTimeout(resolve)); // the page has heard of it too
  const drawn = new Promise((resolve) => run.clock.onDraw(resolve));
  card.restoreContext();
  await restored;
  await drawn;
});
await compare(scenes[0]);
console.log('ok: a card that was lost for a while');
for (const { complaints } of pages) {
  assert.deepEqual(complaints.filter((text) => !/GPU stall due to ReadPixels/.test(text)), []);
}
assert.equal(await server.stop(), 0);
await browser.close();
