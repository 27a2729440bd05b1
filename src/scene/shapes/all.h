// The list of the kinds of shape. To add one, add a file in this folder and a word here; the list determines the
// experiment files, the manual, the renders, the shadows, the kernels and the report. See docs/extending.md.
#pragma once

#include "scene/shapes/box.h"
#include "scene/shapes/disk.h"
#include "scene/shapes/panel.h"
#include "scene/shapes/plane.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/sphere.h"

namespace crescent {

using Shapes = KindList<shapes::Sphere, shapes::Box, shapes::Quad, shapes::Panel, shapes::Plane, shapes::Disk>;

/// A convex shape is a body itself; any other shape consists of bodies() that are.
template <class K>
concept Body = requires(const K body, Sight sight) { body.hidden(sight); };

/// The kinds of a list that are bodies.
template <class Found, class... Kind> struct BodiesOf {
    using List = Found;
};
template <class... Found, class First, class... Rest> struct BodiesOf<KindList<Found...>, First, Rest...> {
    using List = typename std::conditional_t<Body<First>, BodiesOf<KindList<Found..., First>, Rest...>,
        BodiesOf<KindList<Found...>, Rest...>>::List;
};
template <class... Kind> typename BodiesOf<KindList<>, Kind...>::List bodies_in(KindList<Kind...>);
using Bodies = decltype(bodies_in(Shapes{}));

}  // namespace crescent
