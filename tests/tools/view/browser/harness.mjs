// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Starts the program and a browser for a test, and ends both.

import { spawn, spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';

const SKIPPED = 77;
function skip(reason) {
  console.log('skipped: ' + reason);
  process.exit(SKIPPED);
}

export function findChromium() {
  for (const name of [process.env.FLOCKLIFT_CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser']) {
    if (name && existsSync(name)) return name;
  }
  return skip('there is no chromium (Debian: apt-get install chromium)');
}

export async function openBrowser(packages, options = {}) {
  const executablePath = findChromium();
  if (!existsSync(join(packages, 'node_modules/playwright-core'))) {
    skip('playwright-core was not fetched when the page was built');
  }
  const { chromium } = createRequire(resolve(packages, 'package.json'))('playwright-core');
  return chromium.launch({ executablePath, headless: true, timeout: 120000,
    args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--disable-dev-shm-usage'], ...options });
}

export function run(program, args) {
  const done = spawnSync(program, args, { encoding: 'utf8' });
  if (done.status !== 0) throw new Error(args.join(' ') + ': ' + done.stderr);
  return done;
}

// The program's server and its address; stop() ends it as Ctrl-C does and gives its exit status.
export async function serve(program, args) {
  const child = spawn(program, ['view', ...args], { stdio: ['ignore', 'pipe', 'pipe'] });
  process.on('exit', () => child.kill('SIGKILL'));  // a test that fails leaves nothing behind
  let errors = '';
  child.stderr.on('data', (data) => (errors += data));
  const ended = new Promise((resolve) => child.on('exit', (code) => resolve(code)));
  const address = await new Promise((resolve, reject) => {
    let text = '';
    child.stdout.on('data', (data) => {
      text += data;
      const line = text.match(/^(http:\S+)\n/);
      if (line) resolve(line[1]);
    });
    void ended.then((code) => reject(new Error(`the server ended (${code}): ${errors}`)));
  });
  return {
    address,
    pid: child.pid,
    async stop() {
      child.kill('SIGINT');
      return ended;
    },
  };
}

// An empty window.
export async function openWindow(browser, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(120000);
  return page;
}

// A page whose complaints are collected: they are faults of the test at its end.
export async function openPage(browser, address, options = {}) {
  return loadPage(await openWindow(browser, options), address);
}

// The same in a window that is open.
export async function loadPage(page, address) {
  const complaints = [];
  page.on('console', (message) => {
    if (message.type() === 'error') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => {
    const url = request.url();
    if (!/^(blob:|data:|file:)/.test(url) && !url.startsWith(new URL(address).origin)) {
      complaints.push('loads from outside: ' + url);
    }
  });
  await page.goto(address);
  return { page, context: page.context(), complaints };
}

// Asks again until the answer is true; the test's own time limit is ctest's.
export async function until(what, ask) {
  const start = Date.now();
  for (;;) {
    const answer = await ask();
    if (answer) return answer;
    if (Date.now() - start > 110000) throw new Error('waited in vain: ' + what);
    await new Promise((resolve) => setTimeout(resolve, 25));
  }
}
