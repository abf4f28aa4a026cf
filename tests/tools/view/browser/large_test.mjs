// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node large_test.mjs PROGRAM PACKAGES SCRATCH: the page of a large flock, whose files are not read
// as a whole before it opens; and the same where a file is damaged.

import assert from 'node:assert/strict';
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { loadPage, openBrowser, openPage, openWindow, serve, until } from './harness.mjs';

const BIRDS = 400;
const FRAMES = 1000;
const BAD = 700; // the frame that is damaged, in the second run

const [program, packages, scratch] = process.argv.slice(2);
const browser = await openBrowser(packages);
rmSync(scratch, { recursive: true, force: true });
mkdirSync(scratch, { recursive: true });
const say = (what) => console.log('ok: ' + what);

const depthOf = (bird, frame) => 40 + (bird % 20) + 0.01 * frame;
const pad = '00000000'; // digits that make the files as large as those of a long film
function makeFiles(bad) {
  const tracks = ['# fps=50'];
  const flight = ['# fps=50', 'frame,id,x,y,z,vx,vy,vz'];
  for (let f = 1; f <= FRAMES; f++) {
    for (let b = 1; b <= BIRDS; b++) {
      const [x, y, z] = [(b % 25) - 12 + 0.001 * f, Math.floor(b / 25) - 8, depthOf(b, f)];
      const [u, v] = [320 + (500 * x) / z, 180 + (500 * y) / z];
      tracks.push(`${f},${b},${u.toFixed(4)}${pad},${v.toFixed(4)}${pad},5,4,1,-1,-1,-1`);
      const depth = f === bad && b === 7 ? 'lost' : z.toFixed(4) + pad;
      flight.push(`${f},${b},${x.toFixed(4)}${pad},${y}.0,${depth},0.05,0,0.5`);
    }
  }
  writeFileSync(join(scratch, 'tracks.csv'), tracks.join('\n') + '\n');
  writeFileSync(join(scratch, 'trajectories.csv'), flight.join('\n') + '\n');
}
writeFileSync(join(scratch, 'summary.track.json'), JSON.stringify({ command: 'track', version: '0.1.0',
  options: {}, inputs: [], outputs: [], figures: { suspicious_count: 1, suspicious: [
    { frame: 500, last_frame: 505, kind: 'swap', ids: [3, 4], x: 1, y: 2, chance: 0.4 }] } }));

const depthAt = (page, bird, frame) => page.evaluate(([b, f]) => {
  const { run } = window.flocklift;
  run.clock.go(f);
  const rows = run.before.at(f);
  if (!rows) return null;
  for (let r = rows.start[f - rows.first]; r < rows.start[f - rows.first + 1]; r++) {
    if (run.animals[rows.animal[r]] === String(b)) return rows.position[3 * r + 2];
  }
  return null;
}, [bird, frame]);
const loaded = (page) => page.evaluate(() => Boolean(window.flocklift?.run));

makeFiles(0);
{
  const server = await serve(program, [scratch]);
  // Nothing is read that nobody waits for, until a page has shown its first picture: a browser needs
  // the cores for that. Two seconds are enough for all of it.
  await new Promise((resolve) => setTimeout(resolve, 2000));
  assert.match((await (await fetch(server.address + 'api/session')).json()).edits.reason, /still being read/);
  const window = await openWindow(browser);
  await window.addInitScript(() => {
    const { EventSource } = globalThis;
    globalThis.EventSource = class extends EventSource {
      constructor(address) {
        globalThis.drawnBefore = String(document.querySelector('.flight canvas')?.dataset.frame);
        super(address);
      }
    };
  });
  // All that the first picture needs comes with the page: the server hears of nothing else before.
  const asked = [];
  let answers = () => undefined;
  const mayAnswer = new Promise((resolve) => (answers = resolve));
  await window.route('**/api/**', async (route) => {
    asked.push(new URL(route.request().url()).pathname.split('/').slice(2).join('/'));
    await mayAnswer;
    await route.continue();
  });
  const { page, complaints } = await loadPage(window, server.address);
  await until('the first picture', () => page.evaluate(() =>
    document.querySelector('.flight canvas')?.dataset.frame === '1'));
  const drawn = await page.evaluate(() => {
    const { run } = window.flocklift;
    return [run.boxes, run.before].map((cache) => cache.at(1).start[1]);
  });
  assert.deepEqual(drawn, [BIRDS, BIRDS]);
  answers();
  await until('the page', () => loaded(page));
  assert.equal(await until('listening', () => page.evaluate(() => window.drawnBefore)), '1');
  assert.ok(!asked.includes('api/session'));
  say('the page shows its first picture before anything else is read');
  for (const frame of [1, FRAMES, 500, 37]) {
    const depth = await until('frame ' + frame, () => depthAt(page, 7, frame));
    assert.ok(Math.abs(depth - depthOf(7, frame)) < 1e-3, `${depth} in frame ${frame}`);
  }
  say('frames are there, wherever they are in the files');
  // Of the list of animals there is what one sees, and more when one scrolls.
  const listed = () => page.locator('.animals li').count();
  const many = await until('the list', async () => {
    const before = await listed();
    await page.waitForTimeout(500);
    return before > 0 && before === (await listed()) ? before : 0;
  });
  assert.ok(many < BIRDS / 2, `${many} are listed`);
  await until('more of it', async () => {
    await page.locator('aside').evaluate((aside) => aside.scrollTo(0, aside.scrollHeight));
    return (await listed()) === BIRDS;
  });
  say('the list of animals grows as it is scrolled');
  // While somebody drags, a frame that comes is shown, though another is wanted by then. The answers
  // come when the test lets them; on a machine that stands still for a moment the page may have
  // given up a frame before, so there are several tries.
  const shown = await page.evaluate(async () => {
    const { run } = window.flocklift;
    const canvas = document.querySelector('.flight canvas');
    const drawn = new Set();
    run.clock.onDraw(() => drawn.add(canvas.dataset.frame));
    const next = () => new Promise((resolve) => requestAnimationFrame(resolve));
    const { fetch } = window;
    const tried = [];
    for (let comes = 110; comes < 440; comes += 30) {
      const wanted = comes + 500;
      const base = `api/window?first=${comes}&last=${comes}&what=`;
      const ready = {};
      for (const what of ['boxes', 'before']) ready[what] = await (await fetch(base + what)).arrayBuffer();
      const first = [], rest = [];
      window.fetch = (address, options) => {
        const query = new URL(address).searchParams;
        if (!query.has('what') || !new URL(address).pathname.endsWith('window')) return fetch(address, options);
        const isFirst = query.get('first') === String(comes) && query.get('last') === String(comes);
        return new Promise((resolve, reject) => (isFirst
          ? first.push(() => resolve(new Response(ready[query.get('what')])))
          : rest.push(() => fetch(address, options).then(resolve, reject))));
      };
      drawn.clear();
      run.clock.go(comes);
      while (first.length < 2) await next();
      run.clock.go(wanted);
      for (const answer of first) answer();
      while (drawn.size === 0) await next(); // that frame, or nothing of the one that is wanted
      window.fetch = fetch;
      for (const answer of rest) answer();
      if (drawn.has(String(comes))) return '';
      tried.push(`${comes} came and was wanted before ${wanted}: drawn was "${[...drawn]}"`);
    }
    return tried.join('; ');
  });
  assert.equal(shown, '');
  say('frames are shown while somebody drags');
  await until('the end of reading', () => page.evaluate(() => {
    const { run } = window.flocklift;
    return run.edits.reason === '' && run.store.get().reading === '';
  }));
  assert.equal(await page.locator('.reading').count(), 0);
  assert.equal(await page.evaluate(() => window.flocklift.run.animals.length), BIRDS);
  assert.deepEqual(await page.evaluate(() => window.flocklift.run.store.get().faults), []);
  await page.keyboard.press('F3');
  await until('the doubt of the tracker', () => page.getByText('swapped?').isVisible());
  await page.evaluate(() => window.flocklift.run.clock.go(502));
  await page.keyboard.press('n');
  await page.keyboard.press('x');
  await until('the mend', () => page.getByText(/^swap 3 4 500$/).isVisible());
  await until('no doubt left', () => page.evaluate(() => window.flocklift.run.suspects.length === 0));
  await page.keyboard.press('z');
  await until('the doubt again', () => page.getByText('swapped?').isVisible());
  say('tracks are mended once they are read');
  assert.deepEqual(complaints, []);
  await page.close();
  assert.equal(await server.stop(), 0);
}

makeFiles(BAD);
{
  const server = await serve(program, [scratch]);
  const { page, complaints } = await openPage(browser, server.address);
  await until('the page', () => loaded(page));
  const line = 2 + (BAD - 1) * BIRDS + 7;
  await until('the words', () =>
    page.getByText(`trajectories.csv:${line}: z is \`lost\``).first().isVisible());
  for (const frame of [BAD - 200, BAD + 200]) {
    const depth = await until('frame ' + frame, () => depthAt(page, 7, frame));
    assert.ok(Math.abs(depth - depthOf(7, frame)) < 1e-3);
  }
  await page.evaluate((f) => window.flocklift.run.clock.go(f), BAD);
  await until('the words of the window', async () =>
    (await page.evaluate(() => window.flocklift.run.store.get().message)).includes(`:${line}: z is`));
  assert.deepEqual(complaints.filter((text) => !text.includes('400')), []);
  say('a damaged frame is told by its line, the others are shown');
  await page.close();
  assert.equal(await server.stop(), 0);
}
await browser.close();
