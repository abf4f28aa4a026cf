// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the keys and the mouse do.

import type { Key } from './keys';
import { useValue, type Store } from './state';

export function Help({ store, keys, mouse }: { store: Store; keys: Key[]; mouse: [string, string][] }) {
  const open = useValue(store, (s) => s.help);
  if (!open) return null;
  const groups = [...new Set(keys.map((k) => k.group))];
  return (
    <div class="veil" onClick={() => store.set({ help: false })}>
      <div class="help" role="dialog" aria-label="Keys" onClick={(e) => e.stopPropagation()}>
        <header>
          <h2>Keys and mouse</h2>
          <button onClick={() => store.set({ help: false })}>close</button>
        </header>
        <div class="groups">
          {groups.map((group) => (
            <section>
              <h3>{group}</h3>
              <dl>
                {keys.filter((k) => k.group === group).map((k) => [
                  <dt><kbd>{k.shown}</kbd></dt>, <dd>{k.text}</dd>])}
              </dl>
            </section>
          ))}
          <section class="mouse">
            <h3>Mouse</h3>
            <dl>{mouse.map(([what, does]) => [<dt>{what}</dt>, <dd>{does}</dd>])}</dl>
          </section>
        </div>
      </div>
    </div>
  );
}
