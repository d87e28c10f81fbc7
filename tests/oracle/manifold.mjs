// usage: node manifold.mjs MANIFOLD_JS MESHES
// MESHES: uint32 number of pairs; per pair two meshes, each uint32 vertices, uint32 triangles, float32 coordinates,
// uint32 indices; a second mesh without triangles: none. Prints one JSON array with an answer a pair.
import {readFileSync} from 'node:fs';
import {pathToFileURL} from 'node:url';

const [library, file] = process.argv.slice(2);
const wasm = await (await import(pathToFileURL(library))).default();
wasm.setup();
const {Manifold, Mesh} = wasm;

const bytes = readFileSync(file);
let at = 0;
const number = () => (at += 4, bytes.readUInt32LE(at - 4));
function readMesh() {
  const vertices = number(), triangles = number();
  const take = (Type, n) => {
    const start = at;
    at += 4 * n;
    return new Type(bytes.buffer.slice(bytes.byteOffset + start, bytes.byteOffset + at));
  };
  const vertProperties = take(Float32Array, 3 * vertices), triVerts = take(Uint32Array, 3 * triangles);
  return new Mesh({numProp: 3, vertProperties, triVerts});
}

const answers = [];
for (let pairs = number(); pairs > 0; --pairs) {
  const bodyMesh = readMesh(), slabMesh = readMesh();
  const answer = {ok: true, closed: false, volumes: [], reason: ''};
  const made = [];
  try {
    const body = new Manifold(bodyMesh);
    made.push(body);
    answer.closed = body.status() === 'NoError' && !body.isEmpty();
    let result = body;
    if (slabMesh.triVerts.length > 0) {
      const slab = new Manifold(slabMesh);
      made.push(slab);
      made.push(result = body.subtract(slab));
    }
    for (const part of result.decompose()) {
      answer.volumes.push(part.volume());
      made.push(part);
    }
    answer.volumes.sort((a, b) => b - a);
  } catch (error) {
    answer.ok = false;
    answer.reason = String(error.message ?? error);
  }
  for (const m of made) m.delete();
  answers.push(answer);
}
console.log(JSON.stringify(answers));
