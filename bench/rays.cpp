// Rays against meshes: crescent's tree and Embree 3, which is the oracle and the anchor of the speed, on the same rays
// and one thread each, or on all. Prints a line for each mesh: hits that differ (and how far from an edge they are),
// rays per second, time of the build, bytes per triangle.
//
//   rays [RAYS [TRIANGLES]]          10^6 rays of each kind, and about 10^6 triangles, by default
//   rays --check [RAYS [TRIANGLES]]  exit code 1 if a hit differs farther from an edge than both programs' errors allow
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <random>
#include <string>

#include <embree3/rtcore.h>

#include "crescent/crescent.h"

namespace {

using namespace crescent;
using Clock = std::chrono::steady_clock;

/// Seconds of processor time of this thread: other programs on the machine do not count.
double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

struct Ray {
    Vec3f o, d;
    float t_max;
};

// ---- Five meshes.

Vec3f unit_vector(std::mt19937& random) {
    std::uniform_real_distribution<float> number(-1, 1);
    for (;;) {
        const Vec3f v = {number(random), number(random), number(random)};
        const float length2 = dot(v, v);
        if (length2 > 0.01f && length2 <= 1) return (1 / std::sqrt(length2)) * v;
    }
}

Mesh sphere(std::uint32_t around, std::uint32_t up) {
    Mesh mesh;
    for (std::uint32_t j = 0; j <= up; ++j)
        for (std::uint32_t i = 0; i < around; ++i) {
            const double theta = pi * j / up, phi = 2 * pi * i / around;
            mesh.positions.push_back(as<float>(
                Vec3d{math::sin(theta) * math::cos(phi), math::cos(theta), -math::sin(theta) * math::sin(phi)}));
        }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * around + i % around; };
    for (std::uint32_t j = 0; j < up; ++j)
        for (std::uint32_t i = 0; i < around; ++i) {
            if (j + 1 < up) mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            if (j > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    return mesh;
}

/// Triangles of about this size at random in a cube of side 2.
Mesh soup(std::size_t count, float size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> number(-1, 1);
    Mesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3f middle = {number(random), number(random), number(random)};
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(middle + size * Vec3f{number(random), number(random), number(random)});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

Mesh bumpy(std::uint32_t around, std::uint32_t up, double waves, double height) {
    Mesh mesh = sphere(around, up);
    for (Vec3f& p : mesh.positions) {
        const double x = static_cast<double>(p.x), y = static_cast<double>(p.y), z = static_cast<double>(p.z);
        const double by = 1 + height * math::sin(waves * x) * math::sin(waves * y + 1) * math::sin(waves * z + 2);
        p = static_cast<float>(by) * p;
    }
    return mesh;
}

Mesh terrain(std::uint32_t side) {
    Mesh mesh;
    for (std::uint32_t j = 0; j <= side; ++j)
        for (std::uint32_t i = 0; i <= side; ++i) {
            const double x = 2.0 * i / side - 1, z = 2.0 * j / side - 1;
            double y = 0;
            for (int k = 0; k < 7; ++k)
                y += 0.2 * std::exp2(-k) * math::sin(std::exp2(k) * 3 * x + k) *
                    math::cos(std::exp2(k) * 2.7 * z + 2 * k);
            mesh.positions.push_back(as<float>(Vec3d{x, y, z}));
        }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (side + 1) + i; };
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i) {
            mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    return mesh;
}

Mesh boxes(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> number(-1, 1);
    Mesh mesh;
    for (std::size_t n = 0; n < count; ++n) {
        const Vec3f at = {number(random), number(random), number(random)};
        const float size = 0.01f + 0.03f * std::fabs(number(random));
        const auto begin = static_cast<std::uint32_t>(mesh.positions.size());
        for (unsigned c = 0; c < 8; ++c)
            mesh.positions.push_back(at + Vec3f{c & 1 ? size : -size, c & 2 ? size : -size, c & 4 ? size : -size});
        for (const Triangle t : {Triangle{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4}, {2, 6, 3},
                 {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}})
            mesh.triangles.push_back({begin + t[0], begin + t[1], begin + t[2]});
    }
    return mesh;
}

// ---- Rays of each kind.

const char* const kinds[] = {"random", "grazing", "along edges", "from surfaces"};

std::vector<Ray> rays_of(const Mesh& mesh, int kind, std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> number(0, 1);
    const Bounds box = mesh.bounds();
    const auto place = [&](float far) {
        const Vec3f half = 0.5f * (box.high - box.low), v = {number(random), number(random), number(random)};
        return 0.5f * (box.low + box.high) +
            far * Vec3f{half.x * (2 * v.x - 1), half.y * (2 * v.y - 1), half.z * (2 * v.z - 1)};
    };
    std::vector<Ray> rays;
    while (rays.size() < count) {
        const std::size_t t = random() % mesh.triangles.size();
        const Vec3f a = mesh.corner(t, 0), e1 = mesh.corner(t, 1) - a, e2 = mesh.corner(t, 2) - a;
        const Vec3f n = as<float>(normalize(widen(cross(e1, e2))));
        float u = number(random), v = number(random);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const Vec3f x = a + u * e1 + v * e2;
        Vec3f d = unit_vector(random);
        if (kind == 0) {
            rays.push_back({place(1.5f), d, infinity});
        } else if (kind == 1) {  // nearly in the plane of a triangle
            d = d - (dot(d, n) - 1e-3f * (2 * number(random) - 1)) * n;
            rays.push_back({x - 3.0f * d, d, infinity});
        } else if (kind == 2) {  // towards a point of an edge
            const Vec3f o = place(2);
            rays.push_back({o, a + u * e1 - o, 2});
        } else {
            if (dot(d, n) < 0) d = -d;
            rays.push_back({x + 1e-4f * n, d, infinity});
        }
    }
    return rays;
}

// ---- Embree.

class Embree {
public:
    explicit Embree(const Mesh& mesh) : device_(rtcNewDevice("threads=0")), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        std::memcpy(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()),
            mesh.positions.data(), 12 * mesh.positions.size());
        std::memcpy(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()),
            mesh.triangles.data(), 12 * mesh.triangles.size());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~Embree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    bool occluded(const Ray& r) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay ray = plain(r);
        rtcOccluded1(scene_, &context, &ray);
        return ray.tfar < 0;
    }
    TriangleHit closest(const Ray& r) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit ray{plain(r), {}};
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
        return {ray.ray.tfar, ray.hit.primID, ray.hit.u, ray.hit.v};
    }

private:
    static RTCRay plain(const Ray& r) {
        RTCRay ray{};
        ray.org_x = r.o.x;
        ray.org_y = r.o.y;
        ray.org_z = r.o.z;
        ray.dir_x = r.d.x;
        ray.dir_y = r.d.y;
        ray.dir_z = r.d.z;
        ray.tfar = r.t_max;
        ray.mask = 0xffffffff;
        return ray;
    }
    RTCDevice device_;
    RTCScene scene_;
};

/// A sheared coordinate is off by 6 u of the reach here (bvh.cpp), and once more for the mesh's own space. Embree's
/// test has no shear: d . (e x s) with the edge e and s the sum of its ends, which is off by 7 u of the sum of the
/// absolute products; that is at most 1.16 |d| |e| |s| (the permanent of three unit vectors), and |s| at most 2 sqrt(3)
/// of the reach. The distance of the edge from the ray is this over 2 |d| times the part of e across the ray.
constexpr double own_error = 16, embree_error = 7 * 1.16 * 1.7321;  // u
/// In the mesh's own space origin and corners are rounded, by u of its coordinates however near the origin is: sqrt(3)
/// u each.
constexpr double rounding = 2 * 1.7321;  // u

double largest_side(const Mesh& mesh) {
    const Vec3f side = mesh.bounds().high - mesh.bounds().low;
    return std::max({static_cast<double>(side.x), static_cast<double>(side.y), static_cast<double>(side.z)});
}

/// Returns how far the line of a ray passes from the nearest line through an edge of a triangle, in double precision,
/// over the distance that both programs' errors allow there.
double off_the_edges(const Mesh& mesh, std::uint32_t triangle, const Ray& ray, double size) {
    const Vec3d o = widen(ray.o), d = normalize(widen(ray.d));
    double least = 1e30, reach = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d p = widen(mesh.corner(triangle, k)) - o, q = widen(mesh.corner(triangle, (k + 1) % 3)) - o;
        reach = std::max({reach, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        const Vec3d a = p - dot(p, d) * d, e = q - dot(q, d) * d - a, edge = q - p;  // e: in the plane across the ray
        if (!(dot(e, e) > 0)) return 0;
        const Vec3d foot = a - (dot(a, e) / dot(e, e)) * e;
        const double allowed =
            (own_error + embree_error * std::sqrt(dot(edge, edge) / dot(e, e))) * reach + rounding * size;
        least = std::min(least, std::sqrt(dot(foot, foot)) / allowed);
    }
    return least / unit_roundoff;
}

/// Returns by how much t differs if a triangle is moved by the own error times the reach of its coordinates.
double error_of_t(const Mesh& mesh, std::uint32_t triangle, const Ray& ray, double size) {
    const Vec3d o = widen(ray.o), d = widen(ray.d), a = widen(mesh.corner(triangle, 0));
    const Vec3d n = normalize(cross(widen(mesh.corner(triangle, 1)) - a, widen(mesh.corner(triangle, 2)) - a));
    double reach = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d p = widen(mesh.corner(triangle, k)) - o;
        reach = std::max({reach, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    return unit_roundoff * (own_error * reach + rounding * size) / std::max(std::fabs(dot(n, d)), 1e-12);
}

struct RayTimes {
    double rays_per_s = 0;
    std::size_t hits = 0;
};
template <class Occluded> RayTimes time_of(const std::vector<Ray>& rays, const Occluded& occluded) {
    RayTimes best;
    for (int pass = 0; pass < 3; ++pass) {
        best.hits = 0;
        const double begin = processor_seconds();
        for (const Ray& ray : rays) best.hits += occluded(ray);
        best.rays_per_s = std::fmax(best.rays_per_s, static_cast<double>(rays.size()) / (processor_seconds() - begin));
    }
    return best;
}

}  // namespace

int main(int count, char** words) {
    const bool check = count > 1 && std::string(words[1]) == "--check";
    const int first = check ? 2 : 1;
    const std::size_t rays = count > first ? std::stoul(words[first]) : 1000000;
    const double triangles = count > first + 1 ? std::stod(words[first + 1]) : 1e6;
    const auto side = static_cast<std::uint32_t>(std::sqrt(triangles / 2));
    struct Named {
        const char* name;
        Mesh mesh;
    };
    std::vector<Named> meshes;
    meshes.push_back({"sphere", sphere(side, side)});
    meshes.push_back({"bumps", bumpy(side, side, 20, 0.3)});
    meshes.push_back({"terrain", terrain(side)});
    meshes.push_back({"boxes", boxes(static_cast<std::size_t>(triangles / 12), 3)});
    meshes.push_back({"soup", soup(static_cast<std::size_t>(triangles), 0.02f, 5)});
    std::size_t wrong = 0;
    double worst = 0;
    for (const Named& named : meshes) {
        auto begin = Clock::now();
        const Bvh bvh(named.mesh.positions, named.mesh.triangles);
        const double own_build = seconds_since(begin);
        begin = Clock::now();
        const Embree embree(named.mesh);
        const double embree_build = seconds_since(begin);
        const double n = static_cast<double>(named.mesh.triangles.size());
        const double bytes =
            static_cast<double>(bvh.bytes() + 12 * (named.mesh.positions.size() + named.mesh.triangles.size())) / n;
        std::printf("%s: %.0f triangles; build %.2f s (Embree %.2f s); %.1f bytes a triangle\n", named.name, n,
            own_build, embree_build, bytes);
        const Affine to = bvh.to_file().inverse();
        const double size = largest_side(named.mesh);
        /// Whether the origin is on the triangle but for the errors: then either program may find it behind.
        const auto begins_on = [&](const TriangleHit& hit, const Ray& r) {
            return hit.triangle != no_item &&
                static_cast<double>(hit.t) <= error_of_t(named.mesh, hit.triangle, r, size);
        };
        const auto own = [&](const Ray& r) {
            return Ray{as<float>(to.point(widen(r.o))), as<float>(to.vector(widen(r.d))), r.t_max};
        };
        for (int kind = 0; kind < 4; ++kind) {
            const std::vector<Ray> all = rays_of(named.mesh, kind, rays, 11u + static_cast<unsigned>(kind));
            const RayTimes mine = time_of(all, [&](const Ray& r) {
                const Ray in = own(r);
                return bvh.occluded(in.o, in.d, in.t_max);
            });
            const RayTimes theirs = time_of(all, [&](const Ray& r) { return embree.occluded(r); });
            std::size_t differ = 0, far = 0;
            for (const Ray& r : all) {
                const Ray in = own(r);
                const TriangleHit a = bvh.closest(in.o, in.d, in.t_max), b = embree.closest(r);
                if (a.triangle == b.triangle) continue;
                ++differ;
                if (begins_on(a, r) || begins_on(b, r)) continue;
                // A triangle that only one of them hits, or hits first, is met near an edge; or both are met at the
                // same t but for the errors.
                const double off =
                    std::min(a.triangle == no_item ? 1e30 : off_the_edges(named.mesh, a.triangle, r, size),
                        b.triangle == no_item ? 1e30 : off_the_edges(named.mesh, b.triangle, r, size));
                if (a.triangle != no_item && b.triangle != no_item &&
                    std::fabs(static_cast<double>(a.t) - static_cast<double>(b.t)) <=
                        error_of_t(named.mesh, a.triangle, r, size) + error_of_t(named.mesh, b.triangle, r, size))
                    continue;
                worst = std::max(worst, off);
                far += off > 1;
            }
            wrong += far;
            std::printf(
                "  %-14s %6.2f Mrays/s, Embree %6.2f: %.2f of it; %zu of %zu occluded, Embree %zu; %zu closest hits "
                "differ, "
                "%zu away from edges\n",
                kinds[kind], mine.rays_per_s / 1e6, theirs.rays_per_s / 1e6, mine.rays_per_s / theirs.rays_per_s,
                mine.hits, all.size(), theirs.hits, differ, far);
        }
    }
    std::printf("largest distance from an edge where a hit differs: %.2f of what the errors allow\n", worst);
    return check && wrong > 0 ? 1 : 0;
}
