// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node scene_test.mjs PROGRAM PACKAGES SCRATCH: a running scene, steered in a browser.

import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { openBrowser, openPage, run, serve, until } from './harness.mjs';

const [program, packages, scratch] = process.argv.slice(2);
const browser = await openBrowser(packages);
rmSync(scratch, { recursive: true, force: true });
mkdirSync(scratch, { recursive: true });
const scene = join(scratch, 'flock.toml');
writeFileSync(scene, `
[scene]
seed = 4
fps = 60
substeps = 1
box = [[-15, -15, 0], [15, 15, 15]]
[[species]]
name = "bird"
count = 60
speed = 7
model = "boids"
[[predator]]
`);
const server = await serve(program, [scene, '--out', scratch]);
const { page, complaints } = await openPage(browser, server.address);
const look = () => page.evaluate(() => {
  const l = window.flocklift?.swarm?.look;
  return l ? { time: l.time, goals: [...l.goals], position: [...l.position], agents: l.agents } : null;
});
await until('the scene', look);
assert.equal((await look()).agents, 61);

// Pause, step, go on.
await page.keyboard.press('Space');
const standsStill = async () => {  // long enough that a busy computer does not look like it
  const a = (await look()).time;
  await page.waitForTimeout(1000);
  return (await look()).time === a;
};
await until('a pause', standsStill);
const paused = (await look()).time;
await page.keyboard.press('ArrowRight');
await until('a step', async () => (await look()).time > paused && (await standsStill()));
assert.ok(Math.abs((await look()).time - paused - 1 / 60) < 1e-3);
console.log('ok: it runs, pauses and steps');

// Nothing is known of a way to a goal where there is none: its curve comes with the click.
const curves = () => page.locator('.chart:visible').allInnerTexts();
assert.equal((await curves()).length, 3);
assert.ok(!(await curves()).some((words) => words.includes('goal')));

// A click attracts the flock: the mean distance falls, from where it was at the start.
await page.keyboard.press('r');
await until('the start', async () => (await look()).time === 0);
await page.locator('select[aria-label=pace]').selectOption('4');
const canvas = await page.locator('.flight canvas').boundingBox();
await page.mouse.click(canvas.x + 0.75 * canvas.width, canvas.y + 0.3 * canvas.height);
await until('a goal', async () => (await look()).goals.length === 3);
const meanDistance = ({ goals, position }) => {
  let sum = 0;
  for (let k = 0; k < 60; k++) {
    sum += Math.hypot(...[0, 1, 2].map((axis) => position[3 * k + axis] - goals[axis]));
  }
  return sum / 60;
};
const far = meanDistance(await look());
await page.keyboard.press('Space');
await until('the flock comes', async () => meanDistance(await look()) < 0.65 * far);
await until('its curve', async () => (await curves()).some((words) => words.includes('goal')));
console.log('ok: a click attracts the flock');

// So does the crosshair, by keys.
const goalNow = async () => (await look()).goals.join();
const there = await goalNow();
await page.keyboard.press('k');
assert.equal(await page.locator('.flight .crosshair').count(), 1);
for (let k = 0; k < 6; k++) await page.keyboard.press('ArrowLeft');
await until('another goal', async () => {
  await page.keyboard.press('Enter');
  return (await goalNow()) !== there && (await look()).goals.length === 3;
});
await page.keyboard.press('Escape');
assert.equal(await page.locator('.crosshair').count(), 0);
console.log('ok: the crosshair attracts it too');

// A drag moves the goal, another the predator.
const dragFrom = async (place, dx, dy) => {
  const p = await page.evaluate((at) => window.flocklift.swarm.space.onCanvas(...at), place);
  await page.mouse.move(canvas.x + p[0], canvas.y + p[1]);
  await page.mouse.down();
  for (let k = 1; k <= 6; k++) {
    await page.mouse.move(canvas.x + p[0] + (dx * k) / 6, canvas.y + p[1] + (dy * k) / 6);
    await page.waitForTimeout(60);
  }
  await page.mouse.up();
};
await page.keyboard.press('Space');
await page.waitForTimeout(300);
const goal = (await look()).goals;
await dragFrom(goal, -120, 40);
await until('the goal moves', async () => Math.hypot(...(await look()).goals.map((x, k) => x - goal[k])) > 1);
const predator = (await look()).position.slice(180);
await dragFrom(predator, 90, -30);
await until('the predator moves', async () =>
  Math.hypot(...(await look()).position.slice(180).map((x, k) => x - predator[k])) > 0.5);
await page.keyboard.press('Space');
console.log('ok: goals and predators are dragged');

// A slider, a way, and the scene as steered is one that simulate takes.
const input = page.locator('[data-knob="alpha_a"] input');
await input.fill('0.375');
await input.press('Enter');
await page.keyboard.press('d');
await page.mouse.move(canvas.x + 0.3 * canvas.width, canvas.y + 0.5 * canvas.height);
await page.mouse.down();
for (let k = 1; k <= 8; k++) {
  await page.mouse.move(canvas.x + (0.3 + 0.04 * k) * canvas.width, canvas.y + (0.5 - 0.02 * k) * canvas.height);
}
await page.mouse.up();
const name = page.locator('input[aria-label="file name"]');
for (const bad of ['../x.toml', 'x.csv', '/tmp/x.toml']) {
  await name.fill(bad);
  await page.getByRole('button', { name: 'save' }).click();
  await until('words', () => page.locator('.notices .bad').isVisible());
  await page.locator('.notices button').click();
}
const complaintsOfNames = complaints.splice(0); // the refusals, as the console tells them
assert.ok(complaintsOfNames.every((text) => /400/.test(text)), complaintsOfNames.join());
await name.fill('steered.toml');
await page.getByRole('button', { name: 'save' }).click();
await until('saved', () => page.getByText('Saved:').isVisible());
run(program, ['simulate', join(scratch, 'steered.toml'), '--no-video', '--until', '0.2', '--out',
  join(scratch, 'again'), '--quiet']);
const text = readFileSync(join(scratch, 'steered.toml'), 'utf8');
assert.match(text, /alpha_a = 0.375/);
assert.match(text, /waypoints/);
console.log('ok: the scene is saved as steered');

assert.deepEqual(complaints, []);
assert.equal(await server.stop(), 0);

// In a scene with a path a stroke becomes the path, and one can fly along with an animal.
writeFileSync(scene, readFileSync(scene, 'utf8') + '[path]\npoints = [[-9, 0, 3], [9, 0, 3]]\n');
{
  const guided = await serve(program, [scene, '--out', scratch]);
  const opened = await openPage(browser, guided.address);
  const path = () => opened.page.evaluate(async () => (await (await fetch('api/session')).json()).paths[0]);
  await until('the scene', () => opened.page.evaluate(() => window.flocklift?.swarm?.look));
  assert.ok(Math.abs((await path())[0][0] + 9) < 1e-9);
  await opened.page.keyboard.press('d');
  await opened.page.getByText('the curve that guides').waitFor();
  await opened.page.mouse.move(canvas.x + 0.3 * canvas.width, canvas.y + 0.5 * canvas.height);
  await opened.page.mouse.down();
  for (let k = 1; k <= 8; k++) {
    await opened.page.mouse.move(canvas.x + (0.3 + 0.04 * k) * canvas.width, canvas.y + (0.5 - 0.02 * k) * canvas.height);
  }
  await opened.page.mouse.up();
  await until('the path', async () => Math.abs((await path())[0][0] + 9) > 0.01);
  const eye = () => opened.page.evaluate(() => window.flocklift.swarm.space.camera.position.toArray().join());
  await opened.page.keyboard.press('5');
  const there = await eye();
  await until('a flight', async () => (await eye()) !== there);
  console.log('ok: a stroke becomes the path');
  assert.deepEqual(opened.complaints, []);
  assert.equal(await guided.stop(), 0);
}
await browser.close();
