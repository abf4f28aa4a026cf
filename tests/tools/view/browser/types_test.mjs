// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node types_test.mjs PACKAGES: the strict type checker finds nothing in the page's sources.

import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';

const [packages] = process.argv.slice(2);
const checker = join(packages, 'node_modules/typescript/bin/tsc');
if (!existsSync(checker)) {
  console.log('skipped: typescript was not fetched when the page was built');
  process.exit(77);
}
const done = spawnSync(process.execPath, [checker, '--noEmit'], { cwd: packages, stdio: 'inherit' });
process.exit(done.status ?? 1);
