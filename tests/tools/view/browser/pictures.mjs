// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node pictures.mjs PROGRAM PACKAGES SCRATCH SCENE SHEET.jpg [FOOTAGE]: every part of the live page at
// work, on one sheet (`tools/view_pictures`). FOOTAGE is a recorded video that is tracked for it.

import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { goTo } from './film.mjs';
import { openBrowser, openPage, run, serve, until } from './harness.mjs';

const [program, packages, scratch, scene, sheet, footage] = process.argv.slice(2);
const WRONG = [40, 50]; // frames: where two animals are mixed up, and where one looks
const browser = await openBrowser(packages);
rmSync(scratch, { recursive: true, force: true });
mkdirSync(scratch, { recursive: true });
const tiles = [];

async function open(what, options = {}) {
  const server = await serve(program, [what, '--out', scratch]);
  const opened = await openPage(browser, server.address, options);
  const { page, complaints } = opened;
  return {
    page,
    shoot: async (caption) => {
      await page.waitForTimeout(1500); // pictures are drawn when there is time
      tiles.push({ caption, picture: (await page.screenshot()).toString('base64') });
    },
    close: async () => {
      if (complaints.length > 0) throw new Error(complaints.join('; '));
      await opened.context.close();
      await server.stop();
    },
  };
}
const footageThere = (page) =>
  until('the page', () => page.evaluate(() => Boolean(window.flocklift?.footage)));
const at = (page, animal) => page.evaluate((a) => window.flocklift.footage.onScreen(a), animal);

// Looking: the demo's result.
run(program, ['demo', '--out', join(scratch, 'demo'), '--quiet']);
const result = join(scratch, 'demo/result');
{
  const { page, shoot, close } = await open(result);
  await footageThere(page);
  await goTo(page, 60);
  await shoot('look: a synthetic flock, filmed, tracked and reconstructed');
  await page.keyboard.press('F2');
  await page.getByText('use sizes').click();
  await until('a solve', () => page.evaluate(() => window.flocklift.run.solve?.state === 'done'));
  await shoot('re-solve: without apparent size, the flock before and after');
  await close();
}

// Mending: the same tracks, but two that come near each other are mixed up from a frame on.
const rows = readFileSync(join(result, 'tracks.csv'), 'utf8').split('\n');
const seenAt = (frame) => new Map(rows.map((row) => row.split(',').map(Number))
  .filter((r) => r[0] === frame).map(([, id, x, y]) => [id, [x, y]]));
const nearest = () => { // that are well apart, both when they are mixed up and when one looks
  const [then, now] = WRONG.map(seenAt);
  const apart = (places, a, b) =>
    Math.hypot(places.get(a)[0] - places.get(b)[0], places.get(a)[1] - places.get(b)[1]);
  let least = [Infinity];
  for (const a of then.keys()) {
    for (const b of then.keys()) {
      if (a >= b || !now.has(a) || !now.has(b) || apart(now, a, b) < 60) continue;
      const d = apart(then, a, b);
      if (d > 60 && d < least[0]) least = [d, a, b];
    }
  }
  return least.slice(1);
};
const pair = nearest();
const mixed = join(scratch, 'mixed');
cpSync(result, mixed, { recursive: true });
writeFileSync(join(mixed, 'tracks.csv'), rows.map((row) => {
  const cells = row.split(',');
  const which = Number(cells[0]) >= WRONG[0] ? pair.indexOf(Number(cells[1])) : -1;
  if (which >= 0) cells[1] = String(pair[1 - which]);
  return cells.join(',');
}).join('\n'));
{
  const { page, shoot, close } = await open(mixed);
  await footageThere(page);
  await page.keyboard.press('F3');
  await until('suspects', () => page.evaluate(() => window.flocklift.run.suspects !== undefined));
  await goTo(page, WRONG[1]);
  const [first, second] = await page.evaluate((ids) =>
    ids.map((id) => window.flocklift.run.animals.indexOf(String(id))), pair);
  await page.mouse.click(...(await at(page, first)));
  await page.keyboard.down('Shift');
  await page.mouse.click(...(await at(page, second)));
  await page.keyboard.up('Shift');
  const [x, y] = await at(page, first);
  await page.mouse.move(x, y);
  for (let k = 0; k < 3; k++) await page.mouse.wheel(0, -200);
  await page.mouse.move(2, 300);
  await shoot(`mend, before: tracks ${pair.join(' and ')} change places in frame ${WRONG[0]}`);
  await goTo(page, WRONG[0]);
  await page.keyboard.press('x');
  await until('the swap', () => page.evaluate(() => window.flocklift.run.edits.lines.length === 1));
  await goTo(page, WRONG[1]);
  await shoot('mend, after: one key, one line of corrections.txt');
  await page.keyboard.press('?');
  await shoot('every key');
  await close();
}

// Sketching: strokes over the footage, and their flock.
{
  const { page, shoot, close } = await open(result, { colorScheme: 'dark' });
  await footageThere(page);
  await page.keyboard.press('F4');
  const film = await page.locator('.film canvas').boundingBox();
  for (const y of [0.35, 0.5, 0.65]) {
    await page.mouse.move(film.x + 0.2 * film.width, film.y + y * film.height);
    await page.mouse.down();
    for (let k = 1; k <= 24; k++) {
      await page.mouse.move(film.x + (0.2 + 0.025 * k) * film.width,
        film.y + (y + 0.07 * Math.sin(0.35 * k + 4 * y)) * film.height);
    }
    await page.mouse.up();
  }
  const before = await page.evaluate(() => window.flocklift.run.versions.after);
  await page.getByText('find depth of 3 strokes').click();
  await until('the sketch', () => page.evaluate((v) => window.flocklift.run.versions.after > v, before));
  await goTo(page, 45);
  await shoot('sketch: three strokes become tracks, and a flock');
  await close();
}

// Steering: a click attracts the flock.
{
  const { page, shoot, close } = await open(scene, { colorScheme: 'dark' });
  await until('the scene', () => page.evaluate(() => Boolean(window.flocklift?.swarm?.look)));
  const canvas = await page.locator('.flight canvas').boundingBox();
  await page.mouse.click(canvas.x + 0.72 * canvas.width, canvas.y + 0.35 * canvas.height);
  await page.locator('select[aria-label=pace]').selectOption('4');
  const start = await page.evaluate(() => window.flocklift.swarm.look.time);
  await until('some seconds', () => page.evaluate((t) => window.flocklift.swarm.look.time > t + 12, start));
  await page.keyboard.press('Space');
  await shoot('steer: a click attracts a running flock');
  await close();
}

// Recorded footage, if there is any.
if (footage) {
  const recorded = join(scratch, 'recorded');
  run(program, ['track', footage, '--out', recorded, '--quiet']);
  const { page, shoot, close } = await open(recorded);
  await footageThere(page);
  await goTo(page, 30);
  const film = await page.locator('.film canvas').boundingBox();
  await page.mouse.move(film.x + 0.4 * film.width, film.y + 0.5 * film.height);
  for (let k = 0; k < 2; k++) await page.mouse.wheel(0, -200);
  await shoot('recorded footage with its tracks');
  await close();
}

const page = await browser.newPage({ viewport: { width: 1600, height: 100 } });
await page.setContent(`<style>
  body { margin: 0; padding: 12px; background: #fff; font: 17px sans-serif; display: grid;
    grid-template-columns: 1fr 1fr; gap: 12px; }
  figure { margin: 0 } img { width: 100%; display: block; border: 1px solid #999 }
  figcaption { padding: 4px 2px 8px }</style>` + tiles.map(({ caption, picture }) =>
  `<figure><img src="data:image/png;base64,${picture}"><figcaption>${caption}</figcaption></figure>`).join(''));
await page.screenshot({ path: sheet, type: 'jpeg', quality: 82, fullPage: true });
await browser.close();
