"""Cameras that are not part of a robot's own protocol: V4L2, a socket, a video, pictures.

`hal.video.source.open_camera` opens any of them by one string. `hal.video.server.FrameServer`
is the other end of the socket.
"""
