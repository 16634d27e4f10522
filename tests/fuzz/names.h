#pragma once

// read_ply and write_ply from FORMAT=ply.
#define TETWRIGHT_JOIN_(a, b) a##b
#define TETWRIGHT_JOIN(a, b) TETWRIGHT_JOIN_(a, b)
#define READ_FORMAT TETWRIGHT_JOIN(read_, FORMAT)
#define WRITE_FORMAT TETWRIGHT_JOIN(write_, FORMAT)
// read_vtu and write_vtu from BACK=vtu: how a mesh comes back.
#define READ_BACK TETWRIGHT_JOIN(read_, BACK)
#define WRITE_BACK TETWRIGHT_JOIN(write_, BACK)
