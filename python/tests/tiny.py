"""The scene of these tests: a ball under a disk light, which runs in a moment."""

TINY = """
title = "a ball"
seed = 7
seeds = 2
[image]
width = 48
height = 32
[camera]
eye = [0, 0.8, 3.2]
target = [0, 0.5, 0]
vfov_deg = 42
[shapes.ball]
kind = "sphere"
center = [0, 0.65, 0]
radius = 0.65
rho_d = [0.2, 0.2, 0.2]
rho_s = 0.12
s = 32
[disks.key]
center = [1.2, 2.9, 1.3]
normal = [-0.48, -0.81, -0.3369]
radius = 0.3
radiance = [90, 90, 90]
[fill]
radiance = [1.2, 1.2, 1.2]
[arms.cosine]
n = [4, 16]
[arms.phong]
n = 4
[regions.ball]
box = [16, 8, 32, 24]
[assertions."the lobe is better"]
check = "rmse.ball(phong, n=4) < 100"
"""
