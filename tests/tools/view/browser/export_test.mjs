// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node export_test.mjs PROGRAM PACKAGES SCRATCH: the exported page opens from the disk.

import assert from 'node:assert/strict';
import { readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

import { goTo, readFrame } from './film.mjs';
import { openBrowser, openPage, run, until } from './harness.mjs';
import { makeRun } from './make_run.mjs';

const [program, packages, scratch] = process.argv.slice(2);
const browser = await openBrowser(packages);
rmSync(scratch, { recursive: true, force: true });
makeRun(scratch);
run(program, ['reconstruct', join(scratch, 'tracks.csv'), '--camera', join(scratch, 'camera.yaml'),
  '--wingspan', '0.7,0.05', '--speed', '4.5,1', '--out', scratch, '--quiet']);
const file = join(scratch, 'page.html');
run(program, ['view', scratch, '--export', file, '--quiet']);
assert.ok(!readFileSync(file, 'utf8').includes(scratch), 'the page tells where it was made');
const { page, complaints } = await openPage(browser, pathToFileURL(file).href);
await until('the page', () => page.evaluate(() => Boolean(window.flocklift?.footage)));
await page.keyboard.press('b');
await page.keyboard.press('t');
for (const frame of [1, 64, 65, 120, 30]) {
  await goTo(page, frame);
  assert.equal(await readFrame(page), frame);
}
await until('the flock', () => page.evaluate(() =>
  document.querySelector('.flight canvas').dataset.frame === '30'));
assert.equal(await page.locator('nav button').count(), 0);
assert.deepEqual(complaints, []);
await browser.close();
console.log('ok: the exported page opens from the disk');
