// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node run_test.mjs PROGRAM PACKAGES SCRATCH [SHOTS]: the page of a run, in a browser.

import assert from 'node:assert/strict';
import { existsSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';

import { goTo, readFrame } from './film.mjs';
import { openBrowser, openPage, run, serve, until } from './harness.mjs';
import { FRAMES, makeRun } from './make_run.mjs';

const [program, packages, scratch] = process.argv.slice(2);
const browser = await openBrowser(packages);
rmSync(scratch, { recursive: true, force: true });
makeRun(scratch);
run(program, ['reconstruct', join(scratch, 'tracks.csv'), '--camera', join(scratch, 'camera.yaml'),
  '--wingspan', '0.7,0.05', '--speed', '4.5,1', '--out', scratch, '--quiet']);
const server = await serve(program, [scratch]);
const { page, complaints } = await openPage(browser, server.address);
const press = (key) => page.keyboard.press(key);
const say = (what) => console.log('ok: ' + what);

await until('the page', () => page.evaluate(() => Boolean(window.flocklift?.footage)));
await goTo(page, 1);
await until('the flock', () => page.evaluate(() =>
  document.querySelector('.flight canvas').dataset.frame === '1'));
await until('all five animals', async () => (await page.locator('.animals li').count()) === 5);
say('the page loads');

// The flock is in sight from every side: the only colours in space but grey are the birds'.
for (const key of ['1', '2', '3', '4']) {
  await press(key);
  const coloured = () => page.evaluate(() => {
    const space = window.flocklift.flight.space.picture;
    for (const draw of window.flocklift.run.clock.drawers) draw();
    const flat = new OffscreenCanvas(space.width, space.height).getContext('2d');
    flat.drawImage(space, 0, 0);
    const { data } = flat.getImageData(0, 0, space.width, space.height);
    let count = 0;
    for (let k = 0; k < data.length; k += 4) {
      const rgb = data.subarray(k, k + 3);
      if (Math.max(...rgb) - Math.min(...rgb) > 60) count++;
    }
    return count;
  });
  await until('birds in view ' + key, async () => (await coloured()) > 15);
}
await press('1');
say('the flock is in sight');

// Scrubbing shows the right frame: the number is read back from the pixels.
await press('b');
await press('t');
for (const frame of [1, 2, FRAMES, 25, 24, 23, 49, 48, 77, 78, 79, 5, 100]) {
  await goTo(page, frame);
  assert.equal(await readFrame(page), frame);
}
const slider = page.locator('.scrub input');
await slider.evaluate((input) => {
  input.value = '60';
  input.dispatchEvent(new Event('input', { bubbles: true }));
});
await until('frame 60', async () => (await readFrame(page)) === 60);
await press('ArrowRight');
await until('frame 61', async () => (await readFrame(page)) === 61);
await press('Home');
await until('frame 1', async () => (await readFrame(page)) === 1);
// While it plays too: whatever frame it says, it shows.
await press('Space');
for (let k = 0; k < 10; k++) {
  const [says, pixels] = [await page.evaluate(() => {
    window.flocklift.footage.draw();
    return window.flocklift.footage.frame;
  }), await readFrame(page)];
  assert.ok(pixels === says || pixels > says, `${pixels} is before ${says}`);
}
await press('Space');
await press('b');
await press('t');
say('every frame is that frame');

// Selecting in one picture selects in the other.
await goTo(page, 30);
const at = (animal) => page.evaluate((a) => window.flocklift.footage.onScreen(a), animal);
const state = () => page.evaluate(() => {
  const { selected, second, table, frame } = window.flocklift.run.store.get();
  return { selected, second, table, frame };
});
await page.mouse.click(...(await at(1)));
assert.equal((await state()).selected, 1);
assert.equal(await page.locator('.animals li.selected').count(), 1);
say('a click selects');

// Every panel and view comes up, and the help names the keys.
for (const key of ['1', '2', '3', '4', '5', '1', 'F2', 'F4', 'F1', 'u', 'g', 'u', 'g', 'i', 'l', 'l', 's', 's', 'i']) {
  await press(key);
}
await press('?');
assert.ok((await page.locator('.help dt').count()) > 30);
await press('Escape');
assert.equal(await page.locator('.help').count(), 0);
say('keys work');

// A swap and its undo change and restore the file and the picture.
await press('F3');
await until('suspects', () => page.evaluate(() => window.flocklift.run.suspects !== undefined));
await goTo(page, 40);
await page.mouse.click(...(await at(0)));
await page.mouse.click(...(await at(2)), { modifiers: [] });
await page.mouse.click(...(await at(0)));
await page.keyboard.down('Shift');
await page.mouse.click(...(await at(2)));
await page.keyboard.up('Shift');
assert.deepEqual([(await state()).selected, (await state()).second], [0, 2]);
await page.mouse.move(2, 300);
const places = async () => JSON.stringify([await at(0), await at(2)]);
const picture = () => page.evaluate(() => {
  window.flocklift.footage.draw();
  return window.flocklift.footage.sheet.toDataURL();
});
const before = await places();
const pictureBefore = await picture();
await press('x');
await until('the swap', async () => (await places()) !== before);
assert.equal(await places(), JSON.stringify(JSON.parse(before).reverse()));
assert.equal(readFileSync(join(scratch, 'corrections.txt'), 'utf8'), 'swap 1 3 40\n');
assert.notEqual(await picture(), pictureBefore);
await press('z');
await until('the undo', async () => (await places()) === before);
assert.ok(!existsSync(join(scratch, 'corrections.txt')));
assert.equal(await picture(), pictureBefore);
await press('y');
await until('the redo', async () => (await places()) !== before);
await press('z');
await until('the undo', async () => (await places()) === before);
say('a swap and its undo');

// A slider changes the depths, and the command line says it.
await press('F2');
const depth = (table) => page.evaluate(async (what) => {
  const series = await window.flocklift.run.source.series(what, 0);
  return series.depth[Math.floor(series.depth.length / 2)];
}, table);
const original = await depth('before');
await page.locator('.solve select').selectOption('cobyla');
const type = async (knob, value) => {
  const input = page.locator(`[data-knob="${knob}"] input`);
  await input.fill(String(value));
  await input.press('Enter');
};
await type('d-near', 50);
await type('d-far', 60);
await until('a solve', () => page.evaluate(() => window.flocklift.run.solve?.state === 'done' &&
  window.flocklift.run.command.includes('--d-far 60')));
await until('new depths', async () => {
  const now = await depth('after');
  return now >= 50 && now <= 60;
});
assert.ok(original < 49, `it was at ${original}`);
assert.equal((await state()).table, 'after');
await until('the command line', async () => /--method cobyla .*--d-near 50 --d-far 60/.test(
  await page.locator('.line code').innerText()));
say('a slider changes the depths');

// A solve is told of from when it is accepted, and what is left of the one before changes nothing.
const tell = (by, news) => page.evaluate(([more, what]) => {
  const { run } = window.flocklift;
  window.ended ??= run.solve;
  run.setSolve({ ...what, job: window.ended.job + more });
}, [by, news]);
await tell(1, { state: 'accepted' });
await page.getByText('waits for the solve before it').waitFor();
await tell(0, { state: 'running', done: 1, total: 2 });
assert.equal(await page.evaluate(() => window.flocklift.run.solve.state), 'accepted');
await tell(1, { state: 'running', done: 0, total: 0 });
await page.getByText('setting up the equations').waitFor();
await page.evaluate(() => window.flocklift.run.setSolve({ ...window.ended, job: window.ended.job + 1 }));
say('a solve is told of from the first');

// Keys are heard from a slider's field too, and two animals are chosen without the mouse.
const mode = () => page.evaluate(() => window.flocklift.run.store.get().mode);
await page.locator('[data-knob="d-far"] input').focus();
await press('F3');
assert.equal(await mode(), 'mend');
await press('Escape');
for (const key of ['Tab', 'Tab', 'w', 'Tab']) await press(key);
assert.deepEqual([(await state()).selected, (await state()).second], [2, 1]);
await press('Escape');
const eye = () => page.evaluate(() => window.flocklift.flight.space.camera.position.toArray());
for (const key of ['[', 'ArrowUp']) {
  const there = await eye();
  await press(key);
  assert.notDeepEqual(await eye(), there, key);
}
say('the keyboard does it too');

// A pin and an added animal, placed by keys alone: the crosshair starts at the chosen animal.
await goTo(page, 40);
await press('Tab');
const chosen = (await state()).selected;
const [startX, startY] = await at(chosen);
const corrections = () => {
  try {
    return readFileSync(join(scratch, 'corrections.txt'), 'utf8');
  } catch {
    return ''; // there are none
  }
};
const inPicture = (x, y) => page.evaluate(([u, v]) =>
  window.flocklift.footage.toPicture({ clientX: u, clientY: v }), [x, y]);
await press('p');
assert.equal(await page.locator('.film .crosshair').count(), 1);
for (const key of ['ArrowRight', 'Shift+ArrowDown', 'Shift+ArrowDown']) await press(key);
assert.equal((await state()).frame, 40, 'the arrows are the crosshair\'s');
await press('Enter');
await until('the pin', async () => corrections() !== '');
const [, id, frame, x, y] = corrections().match(/^pin (\d+) (\d+) (\S+) (\S+)\n$/);
const wanted = await inPicture(startX + 12, startY + 2);
assert.deepEqual([id, frame], [await page.evaluate((a) => window.flocklift.run.animals[a], chosen), '40']);
assert.ok(Math.hypot(x - wanted[0], y - wanted[1]) < 0.02, `${x} ${y}, not ${wanted}`);
assert.equal(await page.locator('.crosshair').count(), 0);
await press('z');
await until('the undo', async () => corrections() === '');
await press('a');
for (let k = 0; k < 4; k++) await press('ArrowUp');
await press('Escape');
assert.equal(await page.locator('.crosshair').count(), 0);
await press('a'); // not the end of it: it was given up
await press('Enter');
await until('the animal', async () => /^add 40 \S+ \S+\n$/.test(corrections()));
await press('z');
await until('the undo', async () => corrections() === '');
// A track is split, its parts are joined, a track is deleted; undone, it is there again.
const seen = () => page.evaluate(() => window.flocklift.run.animals.filter(
  (_, animal) => window.flocklift.footage.onScreen(animal)));
const isSeen = async (animal, wanted) => (await seen()).includes(animal) === wanted;
const originally = await seen();
const whole = originally[0];
const select = (one, other) => page.evaluate(([first, second]) => {
  const { run } = window.flocklift;
  run.store.set({ selected: run.indexOf(first), second: second ? run.indexOf(second) : -1 });
}, [one, other]);
await select(whole);
await press('c');
await until('two parts', () => isSeen(whole, false));
assert.equal(corrections(), `split ${whole} 40\n`);
const part = (await seen()).find((animal) => !originally.includes(animal));
await select(whole, part);
await press('j');
await until('one again', () => isSeen(whole, true));
assert.equal(corrections(), `split ${whole} 40\njoin ${whole} ${part}\n`);
for (let k = 0; k < 2; k++) await press('z');
await until('the undo', async () => corrections() === '');
await select(whole);
await press('Delete');
await until('one less', () => isSeen(whole, false));
assert.equal(corrections(), `delete ${whole}\n`);
await press('z');
await until('the undo', () => isSeen(whole, true));
assert.equal(corrections(), '');
assert.deepEqual(await seen(), originally);
say('split, join and delete, undone');

// An animal that is hidden is not in the picture until it is shown again.
const shown = await page.evaluate(() => {
  window.flocklift.run.store.set({ selected: -1 });
  window.flocklift.footage.draw();
  const whole = window.flocklift.footage.sheet.toDataURL();
  window.flocklift.run.store.set({ selected: 0 });
  return whole;
});
await press('h');
assert.deepEqual(await page.evaluate(() => [...window.flocklift.run.store.get().hidden]), [0]);
assert.notEqual(await picture(), shown);
await page.evaluate(() => window.flocklift.run.store.set({ hidden: new Set() }));
assert.equal(await picture(), shown);
say('hiding');

// It selects and draws as the mouse does.
await press('k');
assert.equal(await page.locator('.film .crosshair').count(), 1);
await press('k');
assert.equal(await page.locator('.flight .crosshair').count(), 1);
await press('k');
assert.equal(await page.locator('.crosshair').count(), 0);
await press('F4');
await until('the panel', () => page.getByText('find depth of 0 strokes').isVisible());
await press('k');
await press('v');
for (let k = 0; k < 4; k++) await press('ArrowLeft');
await press('v');
await until('a stroke', () => page.getByText('find depth of 1 strokes').isVisible());
await page.getByText('clear').click();
await press('Escape');
await press('?');
assert.ok((await page.locator('.help').innerText()).includes('Crosshair'));
await press('Escape');
say('a crosshair does what the mouse does');

// Strokes become tracks, and a flock.
await press('F4');
const film = await page.locator('.film canvas').boundingBox();
const versions = await page.evaluate(() => window.flocklift.run.versions.after);
for (const y of [0.45, 0.55]) {
  await page.mouse.move(film.x + 0.3 * film.width, film.y + y * film.height);
  await page.mouse.down();
  for (let k = 1; k <= 8; k++) {
    await page.mouse.move(film.x + (0.3 + 0.05 * k) * film.width, film.y + (y + 0.004 * k) * film.height);
  }
  await page.mouse.up();
}
await page.getByText('find depth of 2 strokes').click();
await until('the sketch', () => page.evaluate((v) => window.flocklift.run.versions.after > v, versions));
assert.ok(existsSync(join(scratch, 'sketch_tracks.csv')));
// In sight, wherever it is.
await until('the new flock in sight', () => page.evaluate(() => {
  const { run, flight } = window.flocklift;
  const { frame } = run.store.get();
  const rows = run.after.at(frame);
  if (!rows || !run.after.isNew(frame)) return false;
  const { clientWidth, clientHeight } = document.querySelector('.flight canvas');
  for (let r = rows.start[frame - rows.first]; r < rows.start[frame - rows.first + 1]; r++) {
    const p = flight.space.onCanvas(...rows.position.subarray(3 * r, 3 * r + 3));
    if (!p || p[0] < 0 || p[1] < 0 || p[0] > clientWidth || p[1] > clientHeight) return false;
  }
  return true;
}));
say('strokes become tracks');

assert.deepEqual(complaints, []);
assert.equal(await server.stop(), 0);
await until('words', () => page.getByText('The server is gone').isVisible());
say('the page says that the server is gone');

// Without WebGL the page says so, and goes on.
const plain = await openBrowser(packages, { args: ['--no-sandbox', '--disable-gpu', '--disable-3d-apis'] });
const second = await serve(program, [scratch]);
const bare = await openPage(plain, second.address);
await until('words', () => bare.page.getByText('no WebGL').isVisible());
for (const pane of ['.film', '.flight']) {
  await until(pane, () => bare.page.evaluate((p) => document.querySelector(p + ' canvas').dataset.frame === '1', pane));
}
say('the page says that there is no WebGL, and draws');
await plain.close();
assert.equal(await second.stop(), 0);
await browser.close();
