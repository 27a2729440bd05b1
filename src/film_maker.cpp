#include "film_maker.h"

namespace crescent {

FilmMaker& film_maker() {
    static FilmMaker maker;
    return maker;
}

}  // namespace crescent
