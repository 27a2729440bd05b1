// The maker is a static of its function, so that an initialiser of another file may be the first to ask for it.
#include "film_maker.h"

namespace crescent {

FilmMaker& film_maker() {
    static FilmMaker maker;
    return maker;
}

}  // namespace crescent
