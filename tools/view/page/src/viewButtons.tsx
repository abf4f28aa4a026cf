// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where to look at the flock from.

import type { Key } from './keys';
import type { Space } from './space';
import { useValue, type Store, type ViewName } from './state';

export const VIEWS: [ViewName, string][] = [
  ['orbit', 'around'],
  ['camera', 'camera'],
  ['top', 'top'],
  ['side', 'side'],
  ['follow', 'along'],
];

// To move about by keys; the space is there once the page is.
export function moveKeys(space: () => Space | undefined): Key[] {
  const key = (name: string, shown: string, text: string, turn: number, nearer: number): Key => ({
    keys: [name], shown, text, group: 'View', act: () => space()?.move(turn, nearer) });
  return [
    key('[', '[', 'turn left', -0.15, 1),
    key(']', ']', 'turn right', 0.15, 1),
    key('ArrowUp', '↑', 'nearer', 0, 1.15),
    key('ArrowDown', '↓', 'farther', 0, 1 / 1.15),
  ];
}

export function ViewButtons({ store, film }: { store: Store; film: boolean }) {
  const view = useValue(store, (s) => s.view);
  return (
    <div class="views">
      {VIEWS.filter(([name]) => name !== 'camera' || film).map(([name, words]) => (
        <button class={view === name ? 'on' : ''}
          title={name === 'follow' ? 'fly along with the selected animal' : words}
          onClick={() => store.set({ view: name })}>{words}</button>
      ))}
    </div>
  );
}
