// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node attack_test.mjs PROGRAM PACKAGES SCRATCH: a hostile page in the same browser, which has even
// found out the address, can neither read nor write nor frame the page of a run.

import assert from 'node:assert/strict';
import { existsSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { join } from 'node:path';

import { openBrowser, serve } from './harness.mjs';
import { makeRun } from './make_run.mjs';

const [program, packages, scratch] = process.argv.slice(2);
const browser = await openBrowser(packages);
rmSync(scratch, { recursive: true, force: true });
makeRun(scratch);
const server = await serve(program, [scratch]);

const hostile = createServer((_, response) => {
  response.setHeader('Content-Type', 'text/html');
  response.end('<!doctype html><title>hostile</title><form method="post" enctype="text/plain"></form>');
});
await new Promise((resolve) => hostile.listen(0, '127.0.0.1', resolve));

const context = await browser.newContext();
const page = await context.newPage();
// Of another site (a name that means this computer, and is no name of the server's).
for (const host of ['127.0.0.1', 'localhost']) {
  await page.goto(`http://${host}:${hostile.address().port}/`);
  const seen = await page.evaluate(async (address) => {
    const attempt = async (options, path = 'api/session') => {
      try {
        const response = await fetch(address + path, options);
        return response.type === 'opaque' ? 'opaque' : await response.text();
      } catch {
        return 'refused';
      }
    };
    const load = (tag, attribute, path) => new Promise((resolve) => {
      const element = document.createElement(tag);
      element.onload = () => resolve('loaded');
      element.onloadeddata = () => resolve('loaded');
      element.onerror = () => resolve('refused');
      element[attribute] = address + path;
      document.body.append(element);
    });
    const json = { method: 'POST', headers: { 'Content-Type': 'application/json' },
      body: JSON.stringify({ line: 'swap 1 2 3' }) };
    const sends = new Promise((resolve) => {
      const events = new EventSource(address + 'api/events');
      events.onopen = () => resolve('open');
      events.onerror = () => resolve('refused');
    });
    return {
      read: await attempt({}),
      blind: await attempt({ mode: 'no-cors' }),
      write: await attempt(json, 'api/edit'),
      plain: await attempt({ ...json, headers: { 'Content-Type': 'text/plain' }, mode: 'no-cors' }, 'api/edit'),
      picture: await load('img', 'src', 'frame/1'),
      page: await attempt({}, ''),
      script: await load('script', 'src', ''),
      film: await load('video', 'src', 'video'),
      events: await sends,
    };
  }, server.address);
  assert.equal(seen.read, 'refused');
  assert.equal(seen.page, 'refused');
  assert.equal(seen.write, 'refused');
  for (const what of ['picture', 'script', 'film', 'events']) assert.equal(seen[what], 'refused', what);
  for (const what of ['blind', 'plain']) assert.ok(['opaque', 'refused'].includes(seen[what]), what);
  assert.ok(!existsSync(join(scratch, 'corrections.txt')), 'a hostile page wrote');
  // A frame stays empty, and a form does not write.
  await page.evaluate((address) => {
    const frame = document.createElement('iframe');
    frame.src = address;
    document.body.append(frame);
  }, server.address);
  await page.waitForTimeout(500);
  for (const frame of page.frames().slice(1)) {
    assert.equal(await frame.locator('#app').count().catch(() => 0), 0, 'the page was framed');
  }
  await page.evaluate((address) => {
    const form = document.forms[0];
    form.action = address + 'api/edit';
    const input = document.createElement('input');
    input.name = '{"line": "swap 1 2 3", "x": "';
    input.value = '"}';
    form.append(input);
    form.submit();
  }, server.address);
  await page.waitForTimeout(500);
  assert.ok(!existsSync(join(scratch, 'corrections.txt')), 'a form wrote');
  console.log('ok: a page of ' + host + ' is refused');
}

// The right address without the token, and with another one.
const origin = new URL(server.address).origin;
for (const address of [origin + '/', origin + '/api/session', origin + '/' + '0'.repeat(32) + '/']) {
  const response = await page.goto(address);
  assert.equal(response.status(), 404, address);
}
// No name leaves the folder.
for (const name of ['../secret', '..%2f..%2fetc%2fpasswd', '%2fetc%2fpasswd', '....//', 'video.mp4%00.txt']) {
  const response = await fetch(server.address + 'files/' + name);
  assert.ok(response.status >= 400, name);
}
console.log('ok: addresses and names are refused');
assert.equal(await server.stop(), 0);
hostile.close();
await browser.close();
