// Keeps all files of the page, so that it opens without a network.
const files = [/* files */];
const name = `page-${files
  .join()
  .split('')
  .reduce((sum, it) => (sum * 31 + it.charCodeAt(0)) | 0, 7)}`;

self.addEventListener('install', (event) => {
  event.waitUntil(
    caches
      .open(name)
      .then((cache) => cache.addAll(files.map((file) => new Request(file, { cache: 'no-cache' }))))
      .then(() => self.skipWaiting()),
  );
});

self.addEventListener('activate', (event) => {
  const outdated = (names) => names.filter((it) => it.startsWith('page-') && it !== name);
  event.waitUntil(
    caches.keys().then((names) => Promise.all(outdated(names).map((it) => caches.delete(it)))),
  );
});

// Pages from the network where there is one; what they load has its contents in its name.
self.addEventListener('fetch', (event) => {
  const { request } = event;
  if (request.method !== 'GET' || new URL(request.url).origin !== self.location.origin) return;
  const kept = () =>
    caches.match(request, { ignoreSearch: true }).then((it) => it ?? caches.match('index.html'));
  event.respondWith(
    request.mode === 'navigate'
      ? fetch(request).catch(kept)
      : caches.match(request).then((it) => it ?? fetch(request)),
  );
});
