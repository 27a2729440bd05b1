"""Mitsuba's own Cornell box by four integrators, several seeds each, as EXR files for `crescent compare`.

    pip install mitsuba
    python render.py OUT [--seeds 16] [--spp 16] [--size 64]
    crescent compare --arm path='OUT/path-*.exr' --arm both='OUT/both-*.exr' \
                     --arm emitter='OUT/emitter-*.exr' --arm bsdf='OUT/bsdf-*.exr' --reference OUT/reference.exr

`both`, `emitter` and `bsdf` are direct illumination alone; `path` has indirect light too, so it differs from them.
The reference is direct illumination at 64 times the samples. With --bias B one wall's albedo is changed by that share.
"""
import argparse
import os

import mitsuba as mi

# The LLVM variant is many times faster, if libLLVM is found (DRJIT_LIBLLVM_PATH gives its path).
mi.set_variant("scalar_rgb" if os.environ.get("MITSUBA_SCALAR") else "llvm_ad_rgb")

INTEGRATORS = {
    "path": {"type": "path", "max_depth": 6},
    "both": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 1},
    "emitter": {"type": "direct", "emitter_samples": 2, "bsdf_samples": 0},
    "bsdf": {"type": "direct", "emitter_samples": 0, "bsdf_samples": 2},
}


def scene(integrator, size, bias):
    box = mi.cornell_box()
    box["integrator"] = integrator
    box["sensor"]["film"].update(
        width=size, height=size, pixel_format="rgb", component_format="float32", rfilter={"type": "box"})
    if bias:
        green = box["green"]["reflectance"]["value"]
        box["green"]["reflectance"]["value"] = [c * (1 + bias) for c in green]
    return mi.load_dict(box)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out")
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--first", type=int, default=0, help="number of the first seed")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--size", type=int, default=64)
    parser.add_argument("--bias", type=float, default=0, help="relative change of the green wall's albedo")
    parser.add_argument("--only", choices=INTEGRATORS, action="append")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    for name in args.only or INTEGRATORS:
        world = scene(INTEGRATORS[name], args.size, args.bias)
        for seed in range(args.first, args.first + args.seeds):
            mi.Bitmap(mi.render(world, spp=args.spp, seed=seed)).write(f"{args.out}/{name}-{seed:04}.exr")
    if not args.only:
        image = mi.render(scene(INTEGRATORS["both"], args.size, args.bias), spp=64 * args.spp, seed=1 << 20)
        mi.Bitmap(image).write(f"{args.out}/reference.exr")


if __name__ == "__main__":
    main()
