/* A room of 4 x 4 x 3 with a window of 0.8 x 0.8 in the wall x = 2, a sun that shines in, and a sky; the same with a
 * brighter sun and a lamp; and the same turned in the world, with the camera. */
#ifndef TWINLIGHT_TESTS_SUPPORT_ROOM_SCENE_H
#define TWINLIGHT_TESTS_SUPPORT_ROOM_SCENE_H

#define ROOM_WALL(points) "Shape \"bilinearmesh\" \"point3 P\" [" points "] "
#define ROOM_HEAD_TURNED(camera, world)                                                                                \
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 18 PixelFilter \"box\" "                          \
    "LookAt -1.8 -1.7 1.5 1 1 1.2 0 0 1 " camera "Camera \"perspective\" \"float fov\" 80 "                            \
    "Integrator \"volpath\" \"integer maxdepth\" 5 WorldBegin " world                                                  \
    "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5] "
#define ROOM_HEAD ROOM_HEAD_TURNED("", "")
#define ROOM_WITH(head, sun)                                                                                           \
    head "LightSource \"distant\" \"rgb L\" [" sun "] \"point3 from\" [5 -2 4] \"point3 to\" [0 0 0] "                 \
         "LightSource \"infinite\" \"rgb L\" [0.6 0.8 1] " ROOM_WALL("-2 -2 0 2 -2 0 -2 2 0 2 2 0")                    \
             ROOM_WALL("-2 -2 3 2 -2 3 -2 2 3 2 2 3") ROOM_WALL("-2 -2 0 2 -2 0 -2 -2 3 2 -2 3")                       \
                 ROOM_WALL("-2 2 0 2 2 0 -2 2 3 2 2 3") ROOM_WALL("-2 -2 0 -2 2 0 -2 -2 3 -2 2 3")                     \
                     ROOM_WALL("2 -2 0 2 2 0 2 -2 1 2 2 1") ROOM_WALL("2 -2 1.8 2 2 1.8 2 -2 3 2 2 3")                 \
                         ROOM_WALL("2 -2 1 2 -0.4 1 2 -2 1.8 2 -0.4 1.8") ROOM_WALL("2 0.4 1 2 2 1 2 0.4 1.8 2 2 1.8")
#define ROOM_SCENE ROOM_WITH(ROOM_HEAD, "9 8 6")
#define ROOM_SCENE_TURNED ROOM_WITH(ROOM_HEAD_TURNED("Rotate -33 1 2 3 ", "Rotate 33 1 2 3 "), "9 8 6")
#define ROOM_SCENE_BRIGHT                                                                                              \
    ROOM_WITH(ROOM_HEAD, "90 80 60") "LightSource \"point\" \"rgb I\" [0.01 0.01 0.01] \"point3 from\" [0 0 2] "

#endif
