// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where to look at the flock from.

import { useValue, type Store, type ViewName } from './state';

export const VIEWS: [ViewName, string][] = [
  ['orbit', 'around'],
  ['camera', 'camera'],
  ['top', 'top'],
  ['side', 'side'],
  ['follow', 'along'],
];

export function ViewButtons({ store, film }: { store: Store; film: boolean }) {
  const view = useValue(store, (s) => s.view);
  return (
    <div class="views">
      {VIEWS.filter(([name]) => name !== 'camera' || film).map(([name, words]) => (
        <button class={view === name ? 'on' : ''}
          title={name === 'follow' ? 'fly along with an animal: the selected one, or one in the middle' : words}
          onClick={() => store.set({ view: name })}>{words}</button>
      ))}
    </div>
  );
}
