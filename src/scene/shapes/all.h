// The one list of the kinds of shape. A new one is a file beside this one and a word here; the list feeds the
// experiment files, the manual, the renders, the shadows, the kernels and the report. docs/extending.md has the steps.
#pragma once

#include "scene/shapes/box.h"
#include "scene/shapes/disk.h"
#include "scene/shapes/panel.h"
#include "scene/shapes/plane.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/sphere.h"

namespace crescent::inline scene {

using Shapes = KindList<shapes::Sphere, shapes::Box, shapes::Quad, shapes::Panel, shapes::Plane, shapes::Disk>;

/// A shape that is convex stands before lights by itself; another one is made of bodies() that are.
template <class K>
concept Body = requires(const K body, Sight sight) { body.hidden(sight); };

/// Of a list of kinds, those that are bodies.
template <class Found, class... Kind> struct BodiesOf {
    using List = Found;
};
template <class... Found, class First, class... Rest> struct BodiesOf<KindList<Found...>, First, Rest...> {
    using List = typename std::conditional_t<Body<First>, BodiesOf<KindList<Found..., First>, Rest...>,
        BodiesOf<KindList<Found...>, Rest...>>::List;
};
template <class... Kind> typename BodiesOf<KindList<>, Kind...>::List bodies_in(KindList<Kind...>);
using Bodies = decltype(bodies_in(Shapes{}));

}  // namespace crescent::inline scene
