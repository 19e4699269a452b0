#!/bin/sh
# glTF through the commands: what is rendered, converted and refused. Runs in the build folder, like command/test_cli.sh.
# Skipped (77) without Assimp.
set -u

# shellcheck source=tests/support/cli.sh
. "${srcdir:-.}/tests/support/cli.sh"

# A square from (-1, -1, 0) to (1, 1, 0): positions, normals, texture coordinates, 16-bit indices of two triangles.
square=AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPwAAgD8AAAAAAACAvwAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAA
square=${square}AAAAAIA/AAAAAAAAgD8AAIA/AACAPwAAgD8AAAAAAAAAAAAAAAAAAAEAAgAAAAIAAwA=
# A PNG of 2 x 2 pixels: red, green, blue, brown, of alpha 1, 0.5, 0.25, 0.
image=iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAHUlEQVR4AQESAO3/AP8AAP8A/wCAAAAA/0CAQCAAOiEFndKnqPAAAAAASUVORK5CYII=

# scene FILE MATERIAL: the square twice, the second emitting, seen by a camera, with an image beside the file.
scene() {
    cat >"$1" <<EOF
{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [ { "nodes": [ 0, 1, 2, 3 ] } ],
  "nodes": [ { "mesh": 0 }, { "mesh": 1, "translation": [ 0, 1.2, 1 ], "rotation": [ 0.70710678, 0, 0, 0.70710678 ] },
    { "camera": 0, "translation": [ 0, 0, 4 ] },
    { "translation": [ 2, 1, 3 ], "extensions": { "KHR_lights_punctual": { "light": 0 } } } ],
  "extensionsUsed": [ "KHR_lights_punctual" ],
  "extensions": { "KHR_lights_punctual": { "lights": [ { "type": "point", "intensity": 20 } ] } },
  "cameras": [ { "type": "perspective", "perspective": { "yfov": 0.7, "aspectRatio": 1.333, "znear": 0.1 } } ],
  "materials": [ { $2 }, { "emissiveFactor": [ 1, 0.8, 0.6 ] } ],
  "images": [ { "uri": "image%20file.png" } ], "textures": [ { "source": 0 } ],
  "meshes": [
    { "primitives": [ { "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 }, "indices": 3, "material": 0 } ] },
    { "primitives": [ { "attributes": { "POSITION": 0 }, "indices": 3, "material": 1 } ] } ],
  "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
    { "bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC3" },
    { "bufferView": 0, "byteOffset": 96, "componentType": 5126, "count": 4, "type": "VEC2" },
    { "bufferView": 0, "byteOffset": 128, "componentType": 5123, "count": 6, "type": "SCALAR" } ],
  "bufferViews": [ { "buffer": 0, "byteLength": 140 } ],
  "buffers": [ { "byteLength": 140, "uri": "data:application/octet-stream;base64,$square" } ] }
EOF
}

# same IMAGE REFERENCE NAME: whether all pixels are the same.
same() {
    "$program" compare --json "$1" "$2" >out 2>err && grep -q '"mse": 0,' out
    result "$3: other pixels" $?
    cmp -s "${1%.exr}.png" "${2%.exr}.png"
    result "$3: another PNG" $?
}

printf %s "$image" | base64 -d >'image file.png'
scene first.gltf '"pbrMetallicRoughness": { "metallicFactor": 0 }'
if "$program" info first.gltf 2>&1 | grep -q 'built without Assimp'; then
    expect 1 'install libassimp-dev and libjansson-dev' convert first.gltf first.pbrt
    file_missing first.pbrt
    echo 'this program was built without Assimp'
    exit 77
fi

# ---- what a file and its conversion show ----------------------------------------------------------------------------

number=0
# Metal, plastic, all textures, glass, a mask: each rendered, converted, rendered.
while IFS= read -r material; do
    number=$((number + 1))
    scene "$number.gltf" "$material"
    render -o read.exr "$number.gltf"
    result "render $number.gltf" $?
    expect 0 "wrote $number.pbrt" convert "$number.gltf" "$number.pbrt"
    render -o converted.exr "$number.pbrt"
    result "render $number.pbrt" $?
    same converted.exr read.exr "$number.gltf, converted"
done <<'EOF'
"pbrMetallicRoughness": { "baseColorFactor": [ 0.9, 0.6, 0.3, 1 ], "roughnessFactor": 0.3 }
"pbrMetallicRoughness": { "baseColorFactor": [ 0.9, 0.6, 0.3, 1 ], "metallicFactor": 0, "roughnessFactor": 0.7 }
"normalTexture": { "index": 0, "scale": 0.3 }, "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicRoughnessTexture": { "index": 0 } }
"pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0 }, "extensions": { "KHR_materials_transmission": { "transmissionFactor": 0.7 } }
"pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicFactor": 0.5 }, "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": 0.7, "clearcoatRoughnessTexture": { "index": 0 }, "clearcoatRoughnessFactor": 0.5 } }
"alphaMode": "MASK", "doubleSided": true, "emissiveFactor": [ 1, 1, 1 ], "emissiveTexture": { "index": 0 }, "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } }
EOF
file_exists 3-meshes/0.ply
file_exists 3-textures/0.png

# In another folder, from another folder, onto files that are there.
mkdir -p elsewhere
expect 0 'wrote elsewhere/3.pbrt' convert 3.gltf elsewhere/3.pbrt
expect 0 'wrote elsewhere/3.pbrt' convert 3.gltf elsewhere/3.pbrt
(cd elsewhere && "$program" render --quiet --integrator=pt --resolution=16x12 --samples=1 --no-png -o a.exr 3.pbrt)
result 'a conversion elsewhere' $?
render --no-png -o read.exr 3.gltf
"$program" compare --json elsewhere/a.exr read.exr | grep -q '"mse": 0,'
result 'a conversion elsewhere: other pixels' $?

# ---- the other commands ---------------------------------------------------------------------------------------------

expect 0 'primitives    4' info 3.gltf
expect 0 '' pyramid --resolution=16x12 --samples=1 --max-depth=3 -o sheet.png 1.gltf
file_exists sheet.png
expect 0 '"triangle": 4' info --json 3.gltf
expect 1 'give it a name that ends in .gltf' info - <3.gltf

# ---- what is refused ------------------------------------------------------------------------------------------------

expect 2 'first.pbrt is not glTF: convert reads .gltf and .glb' convert first.pbrt second.pbrt
expect 2 'second.txt does not end in .pbrt' convert 3.gltf second.txt
expect 2 'convert takes two files, not 1' convert 3.gltf
expect 1 'missing.glb' convert missing.glb second.pbrt
file_missing second.pbrt
expect 1 'nowhere/second.pbrt' convert 3.gltf nowhere/second.pbrt

# Nothing that is there is lost when a conversion fails.
echo kept >second.pbrt
sed 's/"byteLength": 140, "uri"/"byteLength": 999, "uri"/' 3.gltf >short.gltf
expect 1 'short.gltf: error: buffers[0] is truncated: it has 140 of 999 bytes' convert short.gltf second.pbrt
grep -q kept second.pbrt
result 'a failed conversion overwrites the file before it' $?
mkdir -p in-textures
cp 'image file.png' in-textures/0.png
sed 's#image%20file.png#in-textures/0.png#' 3.gltf >in.gltf
expect 1 'the conversion would overwrite a file that the scene reads' convert in.gltf in.pbrt
cmp -s in-textures/0.png 'image file.png'
result 'a conversion overwrites an image of its scene' $?
file_missing in.pbrt
echo file >second-meshes
expect 1 'cannot make the folder second-meshes' convert 3.gltf second.pbrt

# ---- messages -------------------------------------------------------------------------------------------------------

sed 's/"scene": 0,/"extensionsUsed": [ "EXT_example" ], &/; s/"extensionsUsed": . "KHR_lights_punctual" .,//' 1.gltf >extension.gltf
expect 0 'the extension EXT_example is not supported and is ignored' info extension.gltf
expect 0 '' convert --quiet 1.gltf quiet.pbrt
[ ! -s err ]
result 'convert --quiet talks' $?

checks_end
