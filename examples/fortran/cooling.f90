! A state in arrays of Fortran, a run in pieces, every collision in batches.
!
!     gfortran needlework.f90 cooling.f90 $(pkg-config --libs needlework) && ./a.out
module statistics
  use needlework
  implicit none

  type :: counts
    integer :: collisions = 0
    real(c_double) :: lost = 0
  end type

contains

  integer(c_int) function gather(collisions, count, user) bind(c)
    integer(c_size_t), value :: count
    type(needlework_collision), intent(in) :: collisions(count)
    type(c_ptr), value :: user
    type(counts), pointer :: mine
    call c_f_pointer(user, mine)
    mine%collisions = mine%collisions + int(count)
    mine%lost = mine%lost - sum(collisions%energy_change)
    gather = 0  ! anything else stops the run
  end function
end module

program cooling
  use statistics
  implicit none
  integer, parameter :: side = 8, n = side**3
  real(c_double), target :: position(n, 3), velocity(n, 3), director(n, 3)
  character(len=*), parameter :: scene = &
    'collisions = { epsilon = 0.9, tc_relative = 1e-3 }' // new_line('a') // c_null_char
  type(counts), target :: mine
  type(needlework_initial) :: initial
  type(needlework_state) :: into
  type(needlework_limits) :: limits
  type(needlework_totals) :: totals
  type(needlework_error) :: error
  type(c_ptr) :: gas
  integer :: i, piece
  integer(c_int) :: stopped

  do i = 1, n
    position(i, :) = 1.25d0 * [mod(i, side), mod(i / side, side), mod(i / side**2, side)]
  end do
  call random_init(repeatable=.true., image_distinct=.false.)
  call random_number(velocity)
  call random_number(director)
  velocity = velocity - spread(sum(velocity, 1) / n, 1, n)
  director = director - 0.5d0

  initial%count = n
  initial%box = 1.25d0 * side
  initial%position = columns_of(position)
  initial%velocity = columns_of(velocity)
  initial%orientation = columns_of(director)
  gas = needlework_create_from(scene, initial, 0_c_int, error)
  if (.not. c_associated(gas)) then
    print '(a)', text_of(error%message)
    stop 1
  end if
  call require(needlework_set_callback(gas, 1000_c_size_t, c_funloc(gather), c_loc(mine)))

  limits%collisions_per_needle = 2  ! of each piece
  do piece = 1, 5
    call require(needlework_advance(gas, limits, stopped))
    call require(needlework_get_totals(gas, totals))
    print '(a, f7.3, a, f8.5, a, i0, a)', 'time', totals%time, ', energy per needle', &
      totals%energy, ', ', totals%collisions, ' collisions'
  end do
  print '(i0, a, f8.5)', mine%collisions, ' collisions seen; energy per needle that they took', &
    mine%lost / n
  into%position = columns_of(position)
  call require(needlework_get_state(gas, into))
  print '(a, 3f8.4)', 'the first needle is now at', position(1, :)
  call needlework_destroy(gas)

contains

  subroutine require(code)
    integer(c_int), intent(in) :: code
    if (code == needlework_ok) return
    print '(a)', needlework_text(needlework_message(gas))
    stop 1
  end subroutine
end program
