"""Every case, in the order of the page."""

from cases import (AGREE, CHECKERBOARD, CORNELL, FIRST_SKY, GRADIENT, LIT_MESH, NOISE_ALONE, REFERENCES, SCENES,
                   SECOND_SKY, SHARED, ImageCase, SweepCase, TestCase, at_most, benchmark, better_than, exact,
                   mean_within, mitsuba, mitsuba_scene)

MAPS = SHARED / "data" / "environments"

BASELINE_IMAGES = (
    ImageCase(
        "checkerboard", "Checkerboard plane", "A textured plane under a constant white sky: texture coordinates, "
        "repeat, filter. Against Mitsuba.",
        SCENES / "checkerboard.xml", mitsuba("checkerboard"), 16384,
        at_most(mse=5e-7, largest=5e-3) + mean_within(0.001), 10, baseline=CHECKERBOARD,
        options=("--sampler", "sobol"), noisy=False),
    ImageCase(
        "generated-sky", "Empty scene, generated map", "Nothing but an environment map that the project makes itself. "
        "Against Mitsuba.",
        SCENES / "empty_environment.xml", mitsuba("empty_environment"), 16384,
        NOISE_ALONE + AGREE + mean_within(0.003), 3),
    ImageCase(
        "first-sky", "Empty scene, clear HDR sky", "A clear sky with the sun in it (Poly Haven), 1k. Against Mitsuba.",
        SHARED / "benchmark" / "hdr_sky_only.xml", mitsuba("hdr_sky_only"), 4096,
        better_than(FIRST_SKY) + NOISE_ALONE + AGREE + mean_within(0.001), 3, baseline=FIRST_SKY),
    ImageCase(
        "second-sky", "Empty scene, second HDR sky", "A sky over a meadow (Poly Haven), 1k, through the project's "
        "own empty scene. Against Mitsuba.",
        SCENES / "empty_environment.xml", mitsuba("empty_noon_grass"), 4096,
        better_than(SECOND_SKY) + NOISE_ALONE + AGREE + mean_within(0.001), 3, baseline=SECOND_SKY,
        defines=(("map", str(MAPS / "noon_grass_1k.hdr")),)),
    ImageCase(
        "lit-mesh", "Mesh under the generated sky", "A diffuse knot on a textured floor: mesh normals, map sampling, "
        "multiple importance sampling. Against Mitsuba.",
        SCENES / "bunny_under_sky.xml", mitsuba("bunny_under_sky"), 16384,
        better_than(LIT_MESH) + NOISE_ALONE + AGREE + mean_within(0.001), 110, baseline=LIT_MESH,
        files=(SCENES / "environments" / "afternoon.hdr",)),
    ImageCase(
        "lit-bunny", "Stanford bunny under an HDR sky", "70 k triangles on a checkerboard, the sun in the map. Against "
        "Mitsuba.",
        SHARED / "benchmark" / "bunny_hdr_sky.xml", mitsuba("bunny_hdr_sky"), 4096,
        better_than(LIT_MESH) + NOISE_ALONE + AGREE + mean_within(0.001), 25, baseline=LIT_MESH),
    ImageCase(
        "gradient-sky", "Gradient sky", "Against its formula in double, integrated over each pixel by quadrature. "
        "Stars off.",
        SCENES / "gradient_sky.xml", exact.gradient_sky, 4096, at_most(largest=2e-6) + better_than(GRADIENT)[:2], 15,
        size=128, defines=(("density", "0"),), options=("--sampler", "sobol"), baseline=GRADIENT, noisy=False),
    ImageCase(
        "cornell-cloud", "Cloud in a Cornell box", "Henyey-Greenstein 0.6, σₐ 0.001, σₛ 10, an area light with one "
        "side. Against Mitsuba.",
        SCENES / "cornell_cloud.xml", mitsuba("cornell_hg_cloud"), 2048,
        better_than(CORNELL) + NOISE_ALONE + AGREE + mean_within(0.003), 40, baseline=CORNELL),
)

BASELINE_TESTS = (
    TestCase("chi-square-phase", "Chi-square: dual Henyey-Greenstein", "Sampled directions in 200 bins of (cos θ, φ).",
             "statistical", "*BaselineDualHenyeyGreenstein*", "200 000 samples, p = 0.645", 10),
    TestCase("chi-square-first-event", "Chi-square: first event", "Distances through density 0.25, then 0.75; "
             "P(escape) = exp(-1/2).", "statistical", "*BaselineFirstEvent*",
             "200 000 samples, p = 0.445", 10),
    TestCase("chi-square-scatter", "Chi-square: scatter or absorb", "Expected 0.75 : 0.25.", "statistical",
             "*BaselineScatterOrAbsorb*", "79 116 events, p = 0.799", 10),
)

SWEEP = SweepCase(
    "cloud-sweep", "Procedural cloud", "Detail 0, 0.18, 0.38, 0.62: each picture is further from the cube than the one "
    "before, and no step makes more than two thirds of the way.",
    tuple(SCENES / f"cloud_detail_{i}.xml" for i in range(4)), 32, 200, 60)

FURTHER = (
    ImageCase(
        "furnace", "White furnace", "A cloud that absorbs nothing in a uniform sky: 1 in every pixel. Light is "
        "sampled at every vertex, so that the noise shows.",
        SCENES / "white_furnace.xml", exact.constant(1.0), 1024, NOISE_ALONE + AGREE + mean_within(0.001), 10,
        options=("--nee", "all", "--sampler", "independent")),
    ImageCase(
        "furnace-exact", "White furnace, no light sampling", "The same, by scattering alone: no noise, so that "
        "rounding shows.",
        SCENES / "white_furnace.xml", exact.constant(1.0), 16, at_most(largest=2e-6, needs_samples=False), 3, noisy=False),
    ImageCase(
        "mitsuba-hetero-sigmat", "Mitsuba's test scene hetero_sigmat", "A grid of extinction per colour channel, in "
        "constant light.",
        REFERENCES / "hetero_sigmat.xml", mitsuba("hetero_sigmat"), 1536, NOISE_ALONE + AGREE + mean_within(0.003), 15),
    ImageCase(
        "mitsuba-homo-null", "Mitsuba's test scene homo_null", "Homogeneous media with index-matched boundaries, in "
        "constant light.",
        REFERENCES / "homo_null.xml", mitsuba("homo_null"), 1536, NOISE_ALONE + AGREE + mean_within(0.003), 10),
    mitsuba_scene("hetero_sigmat", "test_hetero_sigmat_volpath.xml",
                  "A grid of extinction per colour channel under an environment map, unchanged."),
    mitsuba_scene("homo_null", "test_homo_null_envmap_volpath.xml",
                  "Index-matched boundaries under an environment map, unchanged."),
    benchmark("wdas_sun_sky", "Disney cloud under sun and sky", 4096, 0.003, 30),
    benchmark("cornell_cloud", "Smoke in a Cornell box", 6144, 0.003, 55),
    benchmark("fog_small_light", "Thin fog around a small light", 8192, 0.04, 30,
              text="Its rare bright samples leave more noise than elsewhere."),
    benchmark("furnace", "Ball that absorbs nothing", 256, 0.003, 10,
              options=("--nee", "all", "--sampler", "independent")),
)

CASES = BASELINE_IMAGES + BASELINE_TESTS + (SWEEP,) + FURTHER
